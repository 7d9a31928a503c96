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

impl Reader {
    fn object(&mut self, section: &Section, index: u32, sub: Option<u32>) {
        let missing = |key: &str| {
            let finding = MISSING.at(section.header).fact("section", &*section.name);
            finding.fact("name", key)
        };
        let name = match section.text("ParameterName") {
            Some((Given::Text(name), _)) => Some(name.clone()),
            Some(_) => None,
            None => {
                self.reading.push(missing("ParameterName"));
                None
            }
        };
        let code = section.number("ObjectType").unwrap_or(7.0) as i128;
        let data_type = section.number("DataType").map(|it| it as i128);
        let compact = section.number("CompactSubObj").is_some();
        let has_type = data_type.is_some();
        // Keys that it uses only if they are a number other than 0.
        let numbers = ["DataType", "LowLimit", "HighLimit", "CompactSubObj"];
        let extra = |reading: &mut Reading, keys: &[&str]| {
            for key in keys {
                let counts = !numbers.contains(key) || section.number(key).is_some();
                if let Some((_, at)) = section.text(key).filter(|_| counts) {
                    let finding = EXTRA.at(*at).fact("name", *key);
                    let line = Span {
                        start: at.start - (at.column - 1).min(at.start),
                        ..*at
                    };
                    let fix = matches!(code, 6 | 8 | 9).then(|| Fix::safe().comment_out(line));
                    reading.push(match fix {
                        Some(fix) => finding.fix(fix),
                        None => finding,
                    });
                }
            }
        };
        let access = match section.text("AccessType") {
            Some((Given::Text(word), _)) => word.clone(),
            Some(_) => String::new(),
            None => "rw".into(),
        };
        let limit = |key: &str| {
            let read = section.number(key).map(|it| Read::Number(it as i128));
            // It ignores a limit of 0; most such limits are those of the type.
            let text = section.text(key);
            let is_zero = text.is_some_and(
                |(text, _)| matches!(text, Given::Text(text) if parse_int(text) == Some(0.0)),
            );
            (!is_zero).then_some(read)
        };
        let mut entry = ReadEntry {
            name,
            data_type,
            access: Some(access),
            low: limit("LowLimit"),
            high: limit("HighLimit"),
            ..ReadEntry::default()
        };
        match code {
            5 | 7 => {
                if !has_type {
                    self.reading.push(missing("DataType"));
                }
                extra(&mut self.reading, &["CompactSubObj"]);
                if let (Some(low), Some(high)) =
                    (section.number("LowLimit"), section.number("HighLimit"))
                    && high < low
                {
                    let at = section
                        .text("HighLimit")
                        .map_or(section.header, |(_, at)| *at);
                    self.reading.push(LIMITS.at(at));
                }
                let given = section.text("DefaultValue");
                let text = given.map_or(Given::Null, |(text, _)| text.clone());
                match raw(&text, data_type.unwrap_or(0)) {
                    Ok(read) => entry.default = read.map(Some),
                    Err(()) => self.unfit(given),
                }
            }
            6 | 8 | 9 => {
                if compact && !has_type {
                    self.reading.push(missing("DataType"));
                } else if !compact {
                    extra(
                        &mut self.reading,
                        &[
                            "DataType",
                            "AccessType",
                            "DefaultValue",
                            "PDOMapping",
                            "LowLimit",
                            "HighLimit",
                        ],
                    );
                }
                if sub.is_none() {
                    self.parents.insert(index, 0);
                    let count = ReadEntry {
                        name: Some("Max sub-index".into()),
                        data_type: Some(5),
                        access: Some("rw".into()),
                        default: Some(Some(Read::Number(0))),
                        ..ReadEntry::default()
                    };
                    self.reading.entries.insert((index, 0), count);
                }
                if sub.is_none() {
                    return;
                }
            }
            2 => {
                extra(
                    &mut self.reading,
                    &["PDOMapping", "LowLimit", "HighLimit", "CompactSubObj"],
                );
                entry.data_type = Some(data_type.unwrap_or(0xF));
            }
            _ => {
                let at = section
                    .text("ObjectType")
                    .map_or(section.header, |(_, at)| *at);
                self.reading
                    .push(CODE.at(at).fact("value", code.to_string()));
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
