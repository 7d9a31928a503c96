//! The tables of docs/RULES.md and docs/CIA.md agree with the first lines of the scripts.
//!
//! `ODKIT_ACCEPT=1 cargo test -p od-tests --test rules` writes them again.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;

use od_tests::scripts::{self, Header, cell, compare_page};

const LINKS: &str = "../tests/conformance/";

/// All scripts with their headers.
fn headers() -> Vec<(String, Header)> {
    scripts::all()
        .into_iter()
        .map(|file| {
            let text = fs::read_to_string(&file.path).expect("a script is UTF-8");
            match Header::parse(&text) {
                Ok(header) => (file.name, header),
                Err(what) => panic!("tests/conformance/{}: {what}", file.name),
            }
        })
        .collect()
}

fn link(name: &str) -> String {
    let file = name.rsplit('/').next().unwrap_or(name);
    let short = file.strip_suffix(".script").unwrap_or(file);
    format!("[{short}]({LINKS}{name})")
}

/// The text with a link from each id to its row in MANUALS.md.
fn linked(text: &str) -> String {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-';
    let text = text.replace("MANUALS.md ", "");
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(start) = rest.find(is_part) {
        let (before, word) = rest.split_at(start);
        let end = word.find(|c| !is_part(c)).unwrap_or(word.len());
        let (word, after) = word.split_at(end);
        out.push_str(before);
        let is_id = word.starts_with("U-") || word.starts_with("C-");
        if is_id && word.ends_with(|c: char| c.is_ascii_digit()) {
            let _ = write!(out, "[{word}](MANUALS.md#{})", word.to_lowercase());
        } else {
            out.push_str(word);
        }
        rest = after;
    }
    out + rest
}

fn rules() -> String {
    let headers = headers();
    let mut folders: BTreeMap<&str, Vec<_>> = BTreeMap::new();
    for (name, header) in &headers {
        let (folder, _) = name.rsplit_once('/').unwrap_or(("", name));
        folders.entry(folder).or_default().push((name, header));
    }
    let mut page = String::from(
        "# Rules\n\n\
         What our devices do, where it is written, and the script that shows it.\n\
         [MANUALS.md](MANUALS.md) names the manuals 000, 001 and 003, and has the decisions C-… and\n\
         U-… on their contradictions and gaps.\n\n\
         This page is generated from the first lines of the scripts:\n\
         `ODKIT_ACCEPT=1 cargo test -p od-tests --test rules`.\n",
    );
    for (folder, scripts) in folders {
        let _ = write!(
            page,
            "\n## {folder}\n\n| source | rule | script |\n|---|---|---|\n"
        );
        for (name, header) in scripts {
            let text = |words| linked(&cell(words));
            let (source, rule) = (text(&header.source), text(&header.rule));
            let _ = writeln!(page, "| {source} | {rule} | {} |", link(name));
        }
    }
    page
}

/// One of the 127 cases.
struct Case {
    number: String,
    what: String,
    /// Reason why no script shows it; empty if one does.
    reason: String,
}

fn cases() -> Vec<Case> {
    let path = scripts::root().join("cia/cases.txt");
    let text = fs::read_to_string(path).expect("the list of the cases");
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let [number, _, what, reason] = line.split('|').collect::<Vec<_>>()[..] else {
                panic!("cases.txt: `{line}` is not number | clause | what | reason");
            };
            let [number, what, reason] = [number, what, reason].map(|text| text.trim().into());
            Case {
                number,
                what,
                reason,
            }
        })
        .collect()
}

fn cia() -> String {
    let mut scripts: BTreeMap<String, Vec<(String, Header)>> = BTreeMap::new();
    for (name, header) in headers() {
        if let Some(number) = header.source.strip_prefix("CiA case ") {
            let of_case = scripts.entry(number.to_owned()).or_default();
            of_case.push((name, header));
        }
    }
    let mut rows = String::new();
    let mut shown = 0;
    for case in cases() {
        let there = scripts.remove(&case.number).unwrap_or_default();
        assert_eq!(
            there.is_empty(),
            !case.reason.is_empty(),
            "case {} needs scripts or a reason, not both",
            case.number
        );
        shown += usize::from(!there.is_empty());
        let links: Vec<_> = there
            .iter()
            .map(|(name, header)| format!("{} ({})", link(name), header.devices.join(", ")))
            .collect();
        let how = if links.is_empty() {
            format!("– {}", case.reason)
        } else {
            links.join("<br>")
        };
        let _ = writeln!(rows, "| {} | {} | {how} |", case.number, cell(&case.what));
    }
    assert!(scripts.is_empty(), "no such cases: {:?}", scripts.keys());
    format!(
        "# The CiA conformance test\n\n\
         Its 127 cases, in our words, and the scripts that play them on one family of each\n\
         manual: {shown} of them apply to devices that have no RPDOs, produce no SYNC and have no\n\
         write-only objects. A transfer that no manual has is shown by its refusal; where the\n\
         families answer differently, each has a script of its own.\n\n\
         This page is generated from `tests/conformance/cia`:\n\
         `ODKIT_ACCEPT=1 cargo test -p od-tests --test rules`.\n\n\
         | case | subject | script, or the reason why it has none |\n|---|---|---|\n{rows}"
    )
}

#[test]
fn every_case_of_cia_has_a_script_or_a_reason() {
    assert_eq!(cases().len(), 127);
    if let Err(what) = compare_page("CIA.md", &cia()) {
        panic!("{what}");
    }
}

#[test]
fn every_rule_is_in_the_table() {
    if let Err(what) = compare_page("RULES.md", &rules()) {
        panic!("{what}");
    }
}
