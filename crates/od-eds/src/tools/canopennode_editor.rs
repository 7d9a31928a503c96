//! CANopenEditor of CANopenNode (libEDSsharp), by its public source; it was not run.
//!
//! It ignores an object with an error without telling the user; an error in a list stops the file.

use alloc::collections::BTreeMap;
use alloc::string::String;

use crate::finding::{Form, Rule};
use crate::scan::lines::lines;
use crate::span::Span;
use crate::tools::shared::Names;
use crate::tools::tool::{Differences, Input, OTHERWISE, REJECTS, ReadEntry, Reading, Tool};

const SOURCE: &str =
    "github.com/CANopenNode/CANopenEditor at c8ce3f6, libEDSsharp/CanOpenEDS.cs; issue 62";

pub(crate) static TOOL: Tool = Tool {
    name: "canopennode-editor",
    version: "c8ce3f6",
    source: SOURCE,
    tried: false,
    rules: &[
        &MISSING,
        &LIST,
        &LEFT_OUT,
        &DIFFERENCES.drops,
        &DIFFERENCES.field,
    ],
    read,
    value: None,
    differences: Some(&DIFFERENCES),
};

static DIFFERENCES: Differences = Differences::new(["T0611", "T0612", "T0613", "T0614"], SOURCE);

static MISSING: Rule = Rule {
    code: "T0601",
    title: "a section that the tool needs is missing",
    source: SOURCE,
    says: "{tool} rejects the file: section `[{section}]` is missing; the tool distinguishes upper and lower case",
    help: "add the section",
    example: "a file without [MandatoryObjects]",
    ..REJECTS
};

static LIST: Rule = Rule {
    code: "T0602",
    title: "a line of a list that is not a pair of numbers",
    source: SOURCE,
    says: "{tool} rejects the file: it cannot read `{name}={value}` of `[{section}]` as two numbers of 16 bits",
    help: "write the number of the entry and an index such as `0x2000`",
    example: "Supported_Objects=3",
    ..REJECTS
};

static LEFT_OUT: Rule = Rule {
    code: "T0603",
    title: "an object with a fault, which the tool leaves out",
    source: SOURCE,
    says: "{tool} leaves out `[{section}]`: it has no `{name}`",
    help: "add `{name}`",
    also: &[
        Form {
            says: "{tool} leaves out `[{section}]`: it cannot read its `{name}`",
            help: "write a value of CiA 306-1",
        },
        Form {
            says: "{tool} leaves out `[{section}]`: its object is not in front of it",
            help: "put the section of the object in front of its sub-objects",
        },
    ],
    example: "AccessType=r0",
    ..OTHERWISE
};

/// `Convert.ToInt16` in the base that the text has; C's and decimal numbers beyond 16 bits fail.
fn short(text: &str) -> Option<i128> {
    let trimmed = text.trim();
    let hex = trimmed
        .strip_prefix("0x")
        .or_else(|| trimmed.strip_prefix("0X"));
    match hex {
        Some(digits) => u16::from_str_radix(digits, 16).ok().map(i128::from),
        None if trimmed.len() > 1 && trimmed.starts_with('0') => {
            u16::from_str_radix(trimmed, 8).ok().map(i128::from)
        }
        None => trimmed.parse::<i16>().ok().map(i128::from),
    }
}

struct Section<'a> {
    name: &'a str,
    header: Span,
    pairs: BTreeMap<&'a str, (&'a str, Span)>,
}

/// The sections in file order; of duplicate keys the first one is used.
fn sections(text: &str) -> alloc::vec::Vec<Section<'_>> {
    let mut sections: alloc::vec::Vec<Section<'_>> = alloc::vec::Vec::new();
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    let mut current = None;
    for line in lines(text) {
        let own = line.text.trim_start_matches(';');
        let is_name =
            |name: &str| !name.is_empty() && name.bytes().all(|it| it.is_ascii_alphanumeric());
        let header = own.strip_prefix('[').and_then(|rest| rest.split_once(']'));
        if let Some((name, _)) = header.filter(|(name, _)| is_name(name)) {
            let at = *names.entry(name).or_insert(sections.len());
            if at == sections.len() {
                let header = line.span(&own[..name.len() + 2]);
                sections.push(Section {
                    name,
                    header,
                    pairs: BTreeMap::new(),
                });
            }
            current = Some(at);
            continue;
        }
        let Some((key, value)) = own.split_once('=') else {
            continue;
        };
        let key = key.trim_end_matches(' ');
        let is_key = !key.is_empty()
            && key
                .bytes()
                .all(|it| it.is_ascii_alphanumeric() || it == b'_');
        if let Some(at) = current
            && is_key
            && !line.text.starts_with(';')
        {
            let value = value.trim_start_matches(' ').trim_end();
            sections[at]
                .pairs
                .entry(key)
                .or_insert((value, line.span(value)));
        }
    }
    sections
}

fn read(input: &Input<'_>) -> Reading {
    let mut reading = Reading::default();
    let sections = sections(input.text.unwrap_or(input.decoded));
    for name in ["DeviceInfo", "FileInfo", "MandatoryObjects"] {
        if !sections.iter().any(|section| section.name == name) {
            let finding = MISSING.at(Span::default());
            reading.push(finding.fact("section", name));
        }
    }
    let mut objects = BTreeMap::new();
    for section in &sections {
        if matches!(
            section.name,
            "MandatoryObjects" | "OptionalObjects" | "ManufacturerObjects"
        ) {
            for (key, (value, at)) in &section.pairs {
                let is_count = ["supportedobjects", "nrofentries"]
                    .iter()
                    .any(|it| key.eq_ignore_ascii_case(it));
                if !is_count && (short(key).is_none() || short(value).is_none()) {
                    let finding = LIST.at(*at).fact("section", section.name);
                    reading.push(finding.fact("name", *key).fact("value", *value));
                }
            }
        }
        let (index, sub) = match Names::of(section.name) {
            Names::Object(index) => (index, None),
            Names::Member(index, sub) => (index, Some(sub)),
            _ => continue,
        };
        match object(section, sub.is_some() && !objects.contains_key(&index)) {
            Ok(entry) => {
                let compact = section
                    .pairs
                    .get("CompactSubObj")
                    .and_then(|(text, _)| short(text));
                if compact.is_some_and(|count| count != 0) {
                    reading.on_demand.push(index);
                }
                if sub.is_none() {
                    objects.insert(index, ());
                }
                if let Some(entry) = entry {
                    reading.entries.insert((index, sub.unwrap_or(0)), entry);
                }
            }
            Err((form, name, at)) => {
                let finding = LEFT_OUT.at(at).fact("section", section.name);
                let finding = match form {
                    2 => finding.form(&LEFT_OUT.also[1]),
                    1 => finding.form(&LEFT_OUT.also[0]).fact("name", name),
                    _ => finding.fact("name", name),
                };
                reading.push(finding);
            }
        }
    }
    reading
}

type Fault = (usize, String, Span);

/// Reads an object's section as the tool does; the number of a sentence if the tool ignores the section.
fn object(section: &Section<'_>, is_orphan: bool) -> Result<Option<ReadEntry>, Fault> {
    let get = |key: &str| section.pairs.get(key);
    let missing = |key: &str| (0, String::from(key), section.header);
    let number = |key: &str| match get(key) {
        None => Ok(None),
        Some((text, at)) => short(text).map(Some).ok_or((1, String::from(key), *at)),
    };
    let (name, _) = get("ParameterName").ok_or(missing("ParameterName"))?;
    let code = number("ObjectType")?.unwrap_or(7);
    let compact = number("CompactSubObj")?.unwrap_or(0);
    let mut entry = ReadEntry {
        name: Some(String::from(*name)),
        ..ReadEntry::default()
    };
    let is_many = matches!(code, 6 | 8 | 9);
    if is_many && compact == 0 {
        return Ok(None);
    }
    if code == 7 || is_many {
        if let Some((_, at)) = get("CompactSubObj").filter(|_| code == 7) {
            return Err((1, "CompactSubObj".into(), *at));
        }
        if is_orphan {
            return Err((2, String::new(), section.header));
        }
        get("DataType").ok_or(missing("DataType"))?;
        entry.data_type = number("DataType")?;
        let (access, at) = get("AccessType").ok_or(missing("AccessType"))?;
        let access = access.to_lowercase();
        if !matches!(&*access, "rw" | "ro" | "wo" | "rwr" | "rww" | "const") {
            return Err((1, "AccessType".into(), *at));
        }
        entry.access = Some(access);
        entry.mappable = number("PDOMapping")?.map(|flag| flag == 1).or(Some(false));
    }
    Ok((!is_many).then_some(entry))
}
