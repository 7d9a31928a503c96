//! Reads the sections of a file as python-canopen does, in their order.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};

use super::rules::{COMPACT, ENCODING, LINE, MISSING, NAMES, NUMBER, ORDER, TWICE};
use crate::fact::Key;
use crate::fix::Fix;
use crate::span::Span;
use crate::tools::configparser::{Dialect, Ini, Pair, Section};
use crate::tools::python::{float, from_hex, int};
use crate::tools::shared::{NODE_ID, Names, faults};
use crate::tools::tool::{Input, Read, ReadEntry, Reading};

const DIALECT: Dialect = Dialect {
    inline: &[';'],
    folds: false,
};

/// Reads a value as the tool does.
pub(super) fn value(text: &str, data_type: i128) -> Option<Read> {
    match data_type {
        0xA | 0xF => from_hex(text).map(Read::Bytes),
        0x9 | 0xB => Some(Read::Text(text.into())),
        0x8 | 0x11 => float(text).map(Read::Real),
        _ => {
            let text = text.replace(' ', "").to_uppercase();
            if !text.contains("$NODEID") {
                return int(&text, 0).map(Read::Number);
            }
            let rest = without_node_id(&text);
            let number = int(&rest, 0)?.saturating_add(NODE_ID);
            Some(Read::Number(number))
        }
    }
}

/// The text without each `$NODEID`, and without one `+` on either side of it.
fn without_node_id(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("$NODEID") {
        let before = &rest[..at];
        out.push_str(before.strip_suffix('+').unwrap_or(before));
        let behind = &rest[at + "$NODEID".len()..];
        rest = behind.strip_prefix('+').unwrap_or(behind);
    }
    out + rest
}

/// Reads a limit as the tool does.
pub(super) fn limit(text: &str, data_type: i128) -> Option<Read> {
    let number = int(text, 0)?;
    let bits = match data_type {
        2 => 8,
        3 => 16,
        4 => 32,
        0x15 => 64,
        // Signed types without a known length in this tool.
        0x10 | 0x12..=0x14 => return None,
        _ => return Some(Read::Number(number)),
    };
    let high = (1i128 << (bits - 1)) - 1;
    let number = if number > high {
        number - (1i128 << bits)
    } else {
        number
    };
    Some(Read::Number(number))
}

pub(super) fn read(input: &Input<'_>) -> Reading {
    let mut reading = Reading::default();
    let Some(text) = input.text else {
        reading.push(ENCODING.at(Span::default()));
        return reading;
    };
    if input.has_mark {
        reading.push(ENCODING.at(Span::default()).form(&ENCODING.also[0]));
    }
    let ini = Ini::read(text, &DIALECT);
    faults(&mut reading, &ini, &LINE, &TWICE);
    let mut reader = Reader {
        ini: &ini,
        reading,
        kinds: BTreeMap::new(),
    };
    reader.head();
    for section in ini.all() {
        reader.section(section);
    }
    reader.reading
}

/// Object that the tool makes of a section.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Var,
    Array,
    Record,
}

struct Reader<'a> {
    ini: &'a Ini<'a>,
    reading: Reading,
    kinds: BTreeMap<u32, Kind>,
}

/// Keys of [DeviceInfo] that it reads as numbers, and those of them that are flags.
const NUMBERS: [(&str, bool); 18] = [
    ("BaudRate_10", true),
    ("BaudRate_20", true),
    ("BaudRate_50", true),
    ("BaudRate_125", true),
    ("BaudRate_250", true),
    ("BaudRate_500", true),
    ("BaudRate_800", true),
    ("BaudRate_1000", true),
    ("VendorNumber", false),
    ("ProductNumber", false),
    ("RevisionNumber", false),
    ("SimpleBootUpMaster", true),
    ("SimpleBootUpSlave", true),
    ("Granularity", false),
    ("DynamicChannelsSupported", true),
    ("GroupMessaging", true),
    ("NrOfRXPDO", false),
    ("NrOfTXPDO", false),
];

impl<'a> Reader<'a> {
    fn head(&mut self) {
        if let Some(comments) = self.ini.section("Comments") {
            let count = self.needed(comments, "Lines", Some("Lines=0"));
            let count = count.and_then(|pair| self.number(pair, 0, None));
            for line in 1..=count.unwrap_or(0).max(0) {
                let name = format!("Line{line}");
                if self.ini.get(comments, &name).is_none() {
                    self.missing(comments, &name, Some(&format!("{name}=")));
                    break;
                }
            }
        }
        if let Some(info) = self.ini.section("DeviceInfo") {
            for (key, is_flag) in NUMBERS.into_iter().chain([("LSS_Supported", true)]) {
                if let Some(pair) = self.ini.get(info, key) {
                    let empty = Some(("0", is_flag)).filter(|_| pair.value.is_empty());
                    self.number(pair, 0, empty);
                }
            }
        }
        if let Some(node) = self.ini.section("DeviceComissioning")
            && let Some(pair) = self.ini.get(node, "Baudrate")
        {
            self.number(pair, 10, None);
        }
    }

    fn section(&mut self, section: &'a Section<'a>) {
        if let Names::Dummies = Names::of(&section.name) {
            for dummy in 1..8u32 {
                let name = format!("Dummy{dummy:04}");
                let line = format!("{name}=0");
                let pair = self.needed(section, &name, Some(&line));
                if pair.and_then(|pair| self.number(pair, 10, None)) == Some(1) {
                    self.dummy(dummy, name);
                }
            }
        }
        match Names::of(&section.name) {
            Names::Object(index) => self.object(section, index),
            Names::Member(index, sub) => match self.kinds.get(&index) {
                None => {
                    let at = ORDER.at(section.header).fact("section", &*section.name);
                    self.reading
                        .push(at.fact("object", format!("{index:04X}h")));
                }
                Some(Kind::Var) => {}
                Some(_) => {
                    let entry = self.variable(section);
                    self.reading.entries.insert((index, sub), entry);
                }
            },
            Names::Labels(index) => self.names(section, index),
            Names::Dummies | Names::Other => {}
        }
    }

    fn dummy(&mut self, index: u32, name: String) {
        self.kinds.insert(index, Kind::Var);
        let entry = ReadEntry {
            name: Some(name),
            data_type: Some(i128::from(index)),
            access: Some("const".into()),
            mappable: Some(false),
            default: Some(None),
            parameter: Some(None),
            low: Some(None),
            high: Some(None),
        };
        self.reading.entries.insert((index, 0), entry);
    }

    fn object(&mut self, section: &'a Section<'a>, index: u32) {
        self.needed(section, "ParameterName", None);
        let code = match self.ini.get(section, "ObjectType") {
            Some(pair) => self.number(pair, 0, None).unwrap_or(7),
            None => 7,
        };
        let compact = self.ini.get(section, "CompactSubObj");
        let kind = match code {
            2 | 7 => Kind::Var,
            8 => Kind::Array,
            9 => Kind::Record,
            _ => return,
        };
        // A second section with the same index replaces the first.
        self.kinds.insert(index, kind);
        let gone: alloc::vec::Vec<_> = self
            .reading
            .entries
            .range((index, 0)..(index + 1, 0))
            .map(|(at, _)| *at)
            .collect();
        gone.iter()
            .for_each(|at| drop(self.reading.entries.remove(at)));
        match (kind, compact) {
            (Kind::Var, _) => {
                let entry = self.variable(section);
                self.reading.entries.insert((index, 0), entry);
            }
            (Kind::Array, Some(compact)) => {
                let count = ReadEntry {
                    name: Some("Number of entries".into()),
                    data_type: Some(5),
                    access: Some("rw".into()),
                    mappable: Some(false),
                    default: Some(None),
                    parameter: Some(None),
                    low: Some(None),
                    high: Some(None),
                };
                self.reading.entries.insert((index, 0), count);
                let entry = self.variable(section);
                self.reading.entries.insert((index, 1), entry);
                if int(&compact.value, 0) != Some(0) {
                    self.reading.on_demand.push(index);
                    self.reading.push(COMPACT.at(compact.span));
                    let values = format!("{}Value", section.name);
                    if let Some(values) = self.ini.section(&values) {
                        let at = COMPACT.at(values.header).form(&COMPACT.also[0]);
                        self.reading.push(at.fact("section", &*values.name));
                    }
                }
            }
            _ => {}
        }
    }

    fn variable(&mut self, section: &'a Section<'a>) -> ReadEntry {
        let ini = self.ini;
        let text = |pair: &Pair<'_>| pair.value.to_string();
        let name = self.needed(section, "ParameterName", None).map(text);
        let data_type = self.needed(section, "DataType", None);
        let mut data_type = data_type.and_then(|pair| self.number(pair, 0, None));
        let access = self.needed(section, "AccessType", None);
        let access = access.map(|pair| pair.value.to_lowercase());
        if let Some(own) = data_type.filter(|own| *own > 0x1B) {
            // A type of CANFestival; its section names the basic type.
            data_type = match ini.section(&format!("{own:X}sub1")) {
                Some(base) => {
                    let base = self.needed(base, "DefaultValue", None);
                    base.and_then(|pair| self.number(pair, 0, None))
                }
                None => Some(0xF),
            };
        }
        let mapping = ini.get(section, "PDOMapping");
        let zero = Some(("0", true));
        let mapping =
            mapping.and_then(|pair| self.number(pair, 0, zero.filter(|_| pair.value.is_empty())));
        let given = |key: Key, read: fn(&str, i128) -> Option<Read>| {
            let pair = ini.get(section, key.name())?;
            read(&pair.value, data_type.unwrap_or(0))
        };
        ReadEntry {
            name,
            access,
            mappable: Some(mapping.unwrap_or(0) != 0),
            default: Some(given(Key::DefaultValue, value)),
            parameter: Some(given(Key::ParameterValue, value)),
            low: Some(given(Key::LowLimit, limit)),
            high: Some(given(Key::HighLimit, limit)),
            data_type,
        }
    }

    /// `[2000Name]`
    fn names(&mut self, section: &'a Section<'a>, index: u32) {
        let count = self.needed(section, "NrOfEntries", None);
        let count = count.and_then(|pair| self.number(pair, 10, None));
        let first = self.reading.entries.get(&(index, 1)).cloned();
        let first = first.filter(|_| {
            self.kinds
                .get(&index)
                .is_some_and(|kind| *kind != Kind::Var)
        });
        let Some(first) = first else {
            let at = NAMES.at(section.header).fact("section", &*section.name);
            self.reading
                .push(at.fact("object", format!("{index:04X}h")));
            return;
        };
        for sub in 1..=count.unwrap_or(0).max(0) {
            let key = sub.to_string();
            let Some(pair) = self.ini.get(section, &key) else {
                self.missing(section, &key, None);
                break;
            };
            let entry = ReadEntry {
                name: Some(pair.value.to_string()),
                ..first.clone()
            };
            self.reading.entries.insert((index, sub as u32), entry);
        }
    }

    /// The value of a key; the file is rejected if the key is missing.
    fn needed(
        &mut self,
        section: &'a Section<'a>,
        key: &str,
        line: Option<&str>,
    ) -> Option<&'a Pair<'a>> {
        let found = self.ini.get(section, key);
        if found.is_none() {
            self.missing(section, key, line);
        }
        found
    }

    fn missing(&mut self, section: &'a Section<'a>, key: &str, line: Option<&str>) {
        let finding = MISSING.at(section.header);
        let finding = finding.fact("section", &*section.name).fact("name", key);
        // The fix writes a key in another case in the way that the tool expects.
        let other = section
            .pairs
            .iter()
            .find(|pair| pair.key.eq_ignore_ascii_case(key));
        let finding = match (other, line) {
            (Some(pair), _) => finding
                .fact("line", format!("{key}={}", pair.value))
                .fix(Fix::safe().replace(pair.at, key)),
            (None, Some(line)) => finding
                .fact("line", line)
                .fix(Fix::safe().below(section.header, line)),
            (None, None) => finding
                .form(&MISSING.also[0])
                .fact("line", format!("{key}=")),
        };
        self.reading.push(finding);
    }

    /// A number; the file is rejected if it is missing. `instead` is the text of a fix, and whether it keeps the meaning.
    fn number(
        &mut self,
        pair: &Pair<'_>,
        base: u32,
        instead: Option<(&str, bool)>,
    ) -> Option<i128> {
        let read = int(&pair.value, base);
        if read.is_none() {
            let finding = NUMBER
                .at(pair.span)
                .fact("name", &*pair.key)
                .fact("value", &*pair.value);
            let known =
                crate::scan::number::number(&pair.value).map(|number| (number.to_string(), true));
            let instead = instead
                .map(|(text, safe)| (String::from(text), safe))
                .or(known);
            self.reading.push(match instead {
                Some((text, safe)) => {
                    let fix = if safe { Fix::safe() } else { Fix::unsafe_fix() };
                    finding
                        .fact("text", format!("{}={text}", pair.key))
                        .fix(fix.replace(pair.span, text))
                }
                None => finding.form(&NUMBER.also[0]),
            });
        }
        read
    }
}
