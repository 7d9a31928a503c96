//! The objects of a file as in the package `canopen`: first objects, then sub-objects.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};

use super::ini::{Section, sections};
use super::javascript::{Given, parse_int, raw};
use super::rules::{CODE, EXTRA, LIMITS, MISSING, PARENT, RANGE, TWICE};
use crate::finding::Rule;
use crate::fix::Fix;
use crate::span::Span;
use crate::tools::shared::Names;
use crate::tools::tool::{Input, Read, ReadEntry, Reading};

struct Reader {
    reading: Reading,
    /// Objects that can have members, by index, with the value of their sub-index 0.
    parents: BTreeMap<u32, i128>,
    seen: BTreeMap<u32, Span>,
}

pub(super) fn read(input: &Input<'_>) -> Reading {
    let lossy = || String::from_utf8_lossy(input.bytes);
    let text = input.text.map_or_else(lossy, Cow::Borrowed);
    let sections = sections(&text, input.has_mark);
    let mut reader = Reader {
        reading: Reading::default(),
        parents: BTreeMap::new(),
        seen: BTreeMap::new(),
    };
    for section in &sections {
        if let Names::Object(index) = Names::of(&section.name) {
            if let Some(first) = reader.seen.insert(index, section.header) {
                let finding = TWICE
                    .at(section.header)
                    .fact("object", format!("{index:04X}h"));
                reader
                    .reading
                    .push(finding.related(first, "the first one is here"));
            }
            reader.object(section, index, None);
        }
    }
    for section in &sections {
        if let Names::Member(index, sub) = Names::of(&section.name)
            && section.name.get(4..7) == Some("sub")
        {
            let named = |rule: &'static Rule| {
                let finding = rule.at(section.header).fact("section", &*section.name);
                finding.fact("object", format!("{index:04X}h"))
            };
            if !reader.parents.contains_key(&index) {
                reader.reading.push(named(&PARENT));
                continue;
            }
            reader.object(section, index, Some(sub));
            if sub > 255 {
                reader.reading.push(named(&PARENT).form(&PARENT.also[0]));
            }
        }
    }
    for (index, highest) in reader.parents {
        if let Some(entry) = reader.reading.entries.get_mut(&(index, 0))
            && let Some(Some(Read::Number(number))) = &mut entry.default
        {
            *number = highest;
        }
    }
    reader.reading
}

/// Keys that it uses only if they are a number other than 0.
const NUMBERS: [&str; 4] = ["DataType", "LowLimit", "HighLimit", "CompactSubObj"];

/// Keys of an object with sub-objects that it does not use, unless the object is compact.
const OF_VALUE: [&str; 6] = [
    "DataType",
    "AccessType",
    "DefaultValue",
    "PDOMapping",
    "LowLimit",
    "HighLimit",
];

impl Reader {
    fn object(&mut self, section: &Section, index: u32, sub: Option<u32>) {
        let mut entry = self.entry(section);
        match section.number("ObjectType").unwrap_or(7.0) as i128 {
            5 | 7 => entry.default = self.value(section, entry.data_type),
            6 | 8 | 9 => {
                self.container(section);
                if sub.is_none() {
                    self.parents.insert(index, 0);
                    self.reading.entries.insert((index, 0), count());
                    return;
                }
            }
            2 => {
                let unused = ["PDOMapping", "LowLimit", "HighLimit", "CompactSubObj"];
                self.extra(section, &unused, false);
                entry.data_type = Some(entry.data_type.unwrap_or(0xF));
            }
            code => {
                let at = section.place("ObjectType");
                let finding = CODE.at(at).fact("value", code.to_string());
                self.reading.push(finding);
            }
        }
        let sub = sub.unwrap_or(0);
        if let Some(highest) = self.parents.get_mut(&index) {
            match &entry.default {
                Some(Some(Read::Number(number))) if sub == 0 => *highest = *number,
                _ => *highest = (*highest).max(i128::from(sub)),
            }
        }
        self.reading.entries.insert((index, sub), entry);
    }

    /// Name, type, access and limits, which each section has.
    fn entry(&mut self, section: &Section) -> ReadEntry {
        let name = match section.text("ParameterName") {
            Some((Given::Text(name), _)) => Some(name.clone()),
            Some(_) => None,
            None => {
                self.missing(section, "ParameterName");
                None
            }
        };
        let access = match section.text("AccessType") {
            Some((Given::Text(word), _)) => word.clone(),
            Some(_) => String::new(),
            None => "rw".into(),
        };
        ReadEntry {
            name,
            data_type: section.number("DataType").map(|it| it as i128),
            access: Some(access),
            low: limit(section, "LowLimit"),
            high: limit(section, "HighLimit"),
            ..ReadEntry::default()
        }
    }

    /// The value of a VAR or a sub-object.
    fn value(&mut self, section: &Section, data_type: Option<i128>) -> Option<Option<Read>> {
        if data_type.is_none() {
            self.missing(section, "DataType");
        }
        self.extra(section, &["CompactSubObj"], false);
        let limits = section.number("LowLimit").zip(section.number("HighLimit"));
        if limits.is_some_and(|(low, high)| high < low) {
            self.reading.push(LIMITS.at(section.place("HighLimit")));
        }
        let given = section.text("DefaultValue");
        let text = given.map_or(Given::Null, |(text, _)| text.clone());
        match raw(&text, data_type.unwrap_or(0)) {
            Ok(read) => read.map(Some),
            Err(()) => {
                self.unfit(given);
                None
            }
        }
    }

    /// An object with sub-objects.
    fn container(&mut self, section: &Section) {
        let is_compact = section.number("CompactSubObj").is_some();
        if !is_compact {
            self.extra(section, &OF_VALUE, true);
        } else if section.number("DataType").is_none() {
            self.missing(section, "DataType");
        }
    }

    fn missing(&mut self, section: &Section, key: &str) {
        let finding = MISSING.at(section.header).fact("section", &*section.name);
        self.reading.push(finding.fact("name", key));
    }

    /// Reports keys that it does not use. A fix comments them out in an object with sub-objects.
    fn extra(&mut self, section: &Section, keys: &[&str], is_container: bool) {
        for key in keys {
            let counts = !NUMBERS.contains(key) || section.number(key).is_some();
            let Some((_, at)) = section.text(key).filter(|_| counts) else {
                continue;
            };
            let finding = EXTRA.at(*at).fact("name", *key);
            let line = Span {
                start: at.start - (at.column - 1).min(at.start),
                ..*at
            };
            self.reading.push(if is_container {
                finding.fix(Fix::safe().comment_out(line))
            } else {
                finding
            });
        }
    }

    fn unfit(&mut self, given: Option<&(Given, Span)>) {
        let Some((text, at)) = given else { return };
        let text = match text {
            Given::Text(text) => text.clone(),
            Given::Flag(flag) => flag.to_string(),
            Given::Null => "null".into(),
        };
        let finding = RANGE
            .at(*at)
            .fact("name", "DefaultValue")
            .fact("value", text);
        self.reading.push(finding);
    }
}

/// A limit. It ignores one of 0; most such limits are those of the type.
fn limit(section: &Section, key: &str) -> Option<Option<Read>> {
    let read = section.number(key).map(|it| Read::Number(it as i128));
    let text = section.text(key);
    let is_zero = text
        .is_some_and(|(text, _)| matches!(text, Given::Text(text) if parse_int(text) == Some(0.0)));
    (!is_zero).then_some(read)
}

/// The sub-index 0 that it makes for an object with sub-objects.
fn count() -> ReadEntry {
    ReadEntry {
        name: Some("Max sub-index".into()),
        data_type: Some(5),
        access: Some("rw".into()),
        default: Some(Some(Read::Number(0))),
        ..ReadEntry::default()
    }
}
