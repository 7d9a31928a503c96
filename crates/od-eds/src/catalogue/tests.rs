//! Compares every sentence with the findings that use it, in all cases of this crate and of the tests.

extern crate std;

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::description::Description;
use crate::document::Document;
use crate::patch::{self, Edit, Raw, Target};
use crate::rules::RULES;
use crate::scan::lines;
use od_model::ObjectCode;

/// The names of the facts in the blanks of a text; `key` stands for the key of the finding.
fn blanks<'a>(text: &'a str, names: &mut BTreeSet<&'a str>) {
    for piece in pieces(text) {
        let Piece::Blank(blank) = piece else { continue };
        let (name, value) = blank.split_once('=').unwrap_or((blank, ""));
        let (name, _) = name.split_once(':').unwrap_or((name, ""));
        blanks(value, names);
        if Key::of(name).is_none() && name != "fix" {
            names.insert(name);
        }
    }
}

/// Returns blanks without a fact, and facts without a blank.
fn gaps(finding: &Finding) -> Vec<String> {
    let mut names = BTreeSet::new();
    let labels = finding.related.iter().map(|related| related.says);
    let labels: Vec<&str> = labels.collect();
    for text in [finding.form.says, finding.form.help]
        .into_iter()
        .chain(labels)
    {
        blanks(text, &mut names);
    }
    let mut facts: BTreeSet<&str> = finding.facts.iter().map(|(name, _)| *name).collect();
    if finding.key.is_some() && names.contains("key") {
        facts.insert("key");
    }
    let gaps = names.symmetric_difference(&facts);
    gaps.map(|name| format!("{}: `{name}`", finding.code()))
        .collect()
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let ending = path.extension().unwrap_or_default();
        if path.is_dir() {
            files(&path, found);
        } else if ["eds", "dcf", "xdd"].iter().any(|known| ending == *known) {
            found.push(path);
        }
    }
}

#[test]
fn every_sentence_is_used_and_filled() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    files(&crate_folder.join("cases"), &mut paths);
    files(&crate_folder.join("../../tests/cases"), &mut paths);
    files(&crate_folder.join("../../tests/compile/ui"), &mut paths);
    let mut faults = BTreeSet::new();
    let mut said: BTreeMap<&str, BTreeSet<(&str, &str)>> = BTreeMap::new();
    let documents = paths
        .iter()
        .map(|path| Document::new(fs::read(path).unwrap()));
    let findings = documents.flat_map(|document| document.load().findings);
    for finding in findings
        .chain(faults_of_edits())
        .chain(faults_of_size())
        .chain(faults_of_targets())
    {
        faults.extend(gaps(&finding));
        let forms = said.entry(finding.code()).or_default();
        forms.insert((finding.form.says, finding.form.help));
    }
    // Without the feature no XDD can be read.
    let is_said = |code: &str| {
        cfg!(feature = "xdd")
            || ![
                "E0113", "E0114", "E0115", "E0121", "E0124", "E0429", "W0120", "W0123", "W0204",
                "W0217", "W0252", "W0318", "W0406", "W0430", "W0638", "W0658",
            ]
            .contains(&code)
    };
    for rule in RULES.iter().filter(|rule| is_said(rule.code)) {
        let forms: Vec<_> = rule.forms().map(|form| (form.says, form.help)).collect();
        let empty = BTreeSet::new();
        let said = said.get(rule.code).unwrap_or(&empty);
        for form in forms.iter().filter(|form| !said.contains(form)) {
            faults.insert(format!("{}: no case says {form:?}", rule.code));
        }
        for form in said.iter().filter(|form| !forms.contains(form)) {
            faults.insert(format!(
                "{}: not a sentence of the rule: {form:?}",
                rule.code
            ));
        }
    }
    let faults: Vec<String> = faults.into_iter().collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The findings of all that can be wrong with an edit.
fn faults_of_edits() -> Vec<Finding> {
    let (object, member) = (Target::object, Target::member);
    let number = || Raw::Integer(300);
    let mut description = Description::default();
    let mut findings = patch::apply(&mut description, &[Edit::remove(object(0x1000))]);
    let edits = [
        Edit::add(object(0x1000))
            .name("a")
            .data_type(DataType::Unsigned16)
            .default(number()),
        Edit::add(object(0x1018)).name("a").code(ObjectCode::Record),
        Edit::modify(object(0x1001)),
        Edit::modify(object(0x6666)),
        Edit::add(object(0x1000)),
        Edit::add(member(0x2000, 1)),
        Edit::modify(member(0x1000, 1)),
        Edit::add(member(0x1000, 1)),
        Edit::add(object(0x2001)),
        Edit::modify(object(0x3001)),
        Edit::modify(object(0x1000)).default(Raw::Text("a".into())),
        Edit::add(object(0x2002))
            .name("a")
            .data_type(DataType::Identity)
            .default(number()),
        Edit::modify(object(0x1000)).data_type(DataType::Unsigned8),
        Edit::add(member(0x1018, 1)).code(ObjectCode::Var),
        Edit::add(member(0x1018, 2))
            .name("a")
            .data_type(DataType::Unsigned32),
        Edit::modify(object(0x1018)).default(number()),
        Edit::add(object(0x2003))
            .name("a")
            .data_type(DataType::Unsigned16)
            .capacity(4),
        Edit::add(object(0x2004))
            .name("a")
            .data_type(DataType::Domain)
            .mappable(true),
        Edit::add(object(0x2005))
            .name("a")
            .data_type(DataType::VisibleString)
            .low(number()),
        Edit::add(object(0))
            .name("a")
            .data_type(DataType::Unsigned8),
        Edit::add(object(5))
            .name("a")
            .data_type(DataType::Unsigned8),
    ];
    findings.extend(patch::apply(&mut description, &edits));
    let edits = [Edit::modify(member(0x1018, 9))];
    findings.extend(patch::apply(&mut description, &edits));
    findings
}

/// The findings of a text that is too large.
fn faults_of_size() -> Vec<Finding> {
    let mut text = "junk\n".repeat(10_001);
    text += &"j".repeat(lines::LONGEST + 1);
    text.push('\n');
    for index in 0x2000..0x2000 + 4_000 {
        text += &format!("[{index:04X}]\nObjectType=8\nCompactSubObj=254\n");
    }
    crate::load::parse(&text).findings
}

/// The findings of a description that no target can express.
fn faults_of_targets() -> Vec<Finding> {
    let text = "[1402]\nObjectType=9\n[1402sub1]\nDataType=7\nAccessType=rw\nDefaultValue=0x400\n\
        [1602]\nObjectType=9\n[1602sub0]\nDataType=5\nDefaultValue=9\n\
        [1602sub1]\nDataType=7\nDefaultValue=0x20000001\n\
        [2000]\nDataType=5\nDefaultValue=$NODEID\nLowLimit=1\n[2001]\nDataType=15\n\
        [2002]\nObjectType=8\n[2002sub0]\nDataType=5\n[2002sub255]\nDataType=5\n\
        [2003]\nObjectType=8\nDataType=5\nCompactSubObj=254\n[2003sub255]\nDataType=5\n";
    let mut description = crate::load::parse(text).description;
    let one = description.objects[&0x2001].entries[&0].clone();
    let all = description.objects.get_mut(&0x2003);
    all.unwrap().entries.entry(255).or_insert(one);
    let mut found = crate::convert::canopennode::write(&description, "OD", "", None).findings;
    let text = "[1800]\nObjectType=9\n[1801]\nObjectType=9\n[1801sub1]\nDataType=7\nDefaultValue=0x181\n\
        [1802]\nObjectType=9\n[1A00]\nObjectType=9\n[1A00sub0]\nDataType=5\nDefaultValue=1\n\
        [1A00sub1]\nDataType=7\nDefaultValue=0x20000028\n[1A01]\nObjectType=9\n\
        [1A01sub0]\nDataType=5\nDefaultValue=2\n[1A01sub1]\nDataType=7\nDefaultValue=0x20000028\n\
        [1A01sub2]\nDataType=7\nDefaultValue=0x20000028\n[1A02]\nObjectType=9\n\
        [1A02sub0]\nDataType=5\nDefaultValue=255\n[2000]\nDataType=9\n";
    let description = crate::load::parse(text).description;
    found.extend(crate::convert::dbc::write(&description, 1).1);
    found.extend(faults_of_networks());
    found
}

/// The findings of nodes that do not fit together.
fn faults_of_networks() -> Vec<Finding> {
    let node = |name: &str, id, text: &str| {
        let description = crate::load::parse(text).description;
        crate::network::Node::new(name.into(), id, description)
    };
    let sender = "[1017]\nDataType=6\nDefaultValue=1\n[1800]\nObjectType=9\n[1800sub1]\nDataType=7\nDefaultValue=0x1FF\n\
        [1A00]\nObjectType=9\n[1A00sub0]\nDataType=5\nDefaultValue=1\n[1A00sub1]\nDataType=7\nDefaultValue=0x20000008\n";
    let receiver = "[1016]\nObjectType=8\n[1016sub1]\nDataType=7\nDefaultValue=0x10001\n[1016sub2]\nDataType=7\nDefaultValue=0x70001\n\
        [1400]\nObjectType=9\n[1400sub1]\nDataType=7\nDefaultValue=0x1FF\n\
        [1600]\nObjectType=9\n[1600sub0]\nDataType=5\nDefaultValue=1\n[1600sub1]\nDataType=7\nDefaultValue=0x20000020\n";
    let nodes = [
        node("a", 1, sender),
        node("b", 2, sender),
        node("c", 2, receiver),
        node("d", 3, &sender.replace("0x1FF", "0x5FF")),
    ];
    let mut found = crate::network::check(&nodes, None, 10, 0);
    let waiting = "[1005]\nDataType=7\nDefaultValue=0x80\n[1800]\nObjectType=9\n[1800sub1]\nDataType=7\nDefaultValue=0x182\n\
        [1800sub2]\nDataType=5\nDefaultValue=1\n\
        [1A00]\nObjectType=9\n[1A00sub0]\nDataType=5\nDefaultValue=1\n[1A00sub1]\nDataType=7\nDefaultValue=0x20000008\n";
    let nodes = [node("m", 1, ""), node("a", 2, waiting)];
    for master in [None, Some(0)] {
        found.extend(crate::network::check(&nodes, master, 10, 0));
    }
    let list = "[Topology]\nNodes=9\nNode0Present=1\nNode2Present=2\nNode2DCFName=250\nNode2Name=x\nNode2Name=y\nNode3DCFName=500\nNode3Name=x\n\
        Node3DCFNam=y\n[Topology]\n";
    let dcf = |rate: &str| {
        let text = format!("[DeviceComissioning]\nNodeID=2\nBaudrate={rate}\n");
        Ok(crate::load::parse(&text).description)
    };
    for list in [
        list,
        "[Tropology]\nNode5DCFName=250\n",
        "[Topology]\nNode5Present=1\n",
        "",
    ] {
        let lists = crate::network::node_lists(list, &dcf).into_iter();
        found.extend(lists.flat_map(|list| list.findings));
    }
    let span = crate::span::Span::default();
    let misspelled =
        crate::network::misspelled_key("a", "nodeid", &[("node_id", "")], span, &|_| false);
    found.extend(misspelled);
    for (given, rate) in [("300", Some(300)), ("500k", None), ("fast", None)] {
        found.extend(crate::network::unusual_bit_rate(given, rate, span));
    }
    found.extend(crate::network::text_of_flag("a", "boot", "ja", span));
    found.push(crate::network::no_sync("sync_window", span));
    for (is_line, is_same) in [(false, false), (true, false), (true, true)] {
        let twice = crate::network::key_twice("sdo", span, span, is_line, is_same);
        found.push(twice);
    }
    for (key, given, is_number, most) in [
        ("node_id", "300", true, Some(127)),
        ("sync_period", "5 ms", false, Some(u32::MAX)),
        ("transmission", "-1", true, Some(255)),
    ] {
        let wrong = crate::network::not_a_number("a", key, given, is_number, most, span);
        found.push(wrong);
    }
    found.push(crate::network::no_pdo("a", "tpdo", "0", span));
    found.push(crate::network::missing_key("a", "dcf", "a.eds", span));
    found.push(crate::network::unusable_file(
        "a",
        "a.eds",
        "no object is defined",
        span,
    ));
    found.push(crate::network::unreadable(
        "an alias without its anchor",
        span,
    ));
    let unfit = crate::network::Unfit {
        address: od_model::Address::new(0x1771, 0),
        why: "e: object 1771h:00 does not exist".into(),
    };
    for index in [None, Some(("1005", span))] {
        found.push(crate::network::unfit(
            &node("e", 4, waiting),
            &unfit,
            span,
            index,
        ));
    }
    let mut reserved = node("e", 4, waiting);
    let address = od_model::Address::new(0x1800, 2);
    let write = crate::network::Write::new(address, DataType::Unsigned8, 245);
    reserved.writes.extend(write);
    found.extend(crate::network::unfit_values(&reserved, &|_| span));
    let values =
        "[2000]\nDataType=5\nAccessType=ro\nPDOMapping=1\n[2001]\nDataType=5\nAccessType=rw\n";
    let mapping = node("d", 3, values);
    for index in [0x2000, 0x2001] {
        let address = od_model::Address::new(index, 0);
        found.extend(crate::network::not_mappable(&mapping, true, address, span));
        found.extend(crate::network::read_only(&mapping, address, span));
    }
    found
}

#[test]
fn blanks_are_filled_once() {
    let rule = &crate::rules::E0415;
    let finding = rule
        .finding()
        .key(Key::LowLimit)
        .fact("text", "{low}")
        .fact("count", 1u8);
    let finding = finding
        .fact("low", 0x1Fu32)
        .fact("type", DataType::Unsigned8);
    for (text, expected) in [
        ("{text} is {low}", "{low} is 31"),
        ("0x{low:X} {low:04X}h", "0x1F 001Fh"),
        (
            "{count:entry|entries}, {low:entry|entries}",
            "1 entry, 31 entries",
        ),
        (
            "{key}, {HighLimit}, {key={low}}",
            "LowLimit, HighLimit, LowLimit=31",
        ),
        (
            "{DataType={type}} is {type}",
            "DataType=0x0005 is UNSIGNED8",
        ),
        ("add {{ … }} }", "add { … } }"),
        ("{nothing} {low", "{nothing} {low"),
    ] {
        let blanks = Blanks {
            finding: &finding,
            words: &Eds,
        };
        assert_eq!(blanks.fill(text, false), expected);
    }
}
