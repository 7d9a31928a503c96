//! dcf-tools after its checks: from sections to the objects of a device.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};

use super::rules::{MEMBERS, MISSING, NUMBER, REFERENCE};
use super::values::{limits, value};
use crate::span::Span;
use crate::tools::configparser::{Ini, Pair, Section};

use crate::tools::python::int;
use crate::tools::tool::{Read, ReadEntry, Reading};

/// Reports a value that is not a number.
pub(super) fn unread(reading: &mut Reading, pair: &Pair<'_>) {
    let finding = NUMBER.at(pair.span).form(&NUMBER.also[0]);
    reading.push(finding.fact("name", &*pair.key).fact("value", &*pair.value));
}

/// A value with its type and place.
struct Value {
    read: Option<Read>,
    span: Span,
}

struct Device<'a, 'r> {
    ini: &'a Ini<'a>,
    reading: &'r mut Reading,
    objects: BTreeMap<u32, BTreeMap<u32, Value>>,
}

/// Reads the objects of the lists.
pub(super) fn read<'a>(ini: &'a Ini<'a>, reading: &mut Reading) {
    let mut device = Device {
        ini,
        reading,
        objects: BTreeMap::new(),
    };
    for name in ["MandatoryObjects", "OptionalObjects", "ManufacturerObjects"] {
        let Some(list) = ini.section(name) else {
            let finding = MISSING.at(Span::default()).form(&MISSING.also[0]);
            device.reading.push(finding.fact("section", name));
            continue;
        };
        let count = ini
            .get(list, "SupportedObjects")
            .and_then(|pair| int(&pair.value, 10));
        for number in 1..=count.unwrap_or(0) {
            let Some(pair) = ini.get(list, &number.to_string()) else {
                break;
            };
            if let Some(index) = int(&pair.value, 0).and_then(|index| u32::try_from(index).ok()) {
                device.object(index);
            }
        }
    }
    device.identity();
    for (first, mapping) in [(0x1400, 0x1600), (0x1800, 0x1A00)] {
        for at in 0..512 {
            device.pdo(first + at, mapping + at);
        }
    }
}

impl<'a> Device<'a, '_> {
    fn missing(&mut self, section: &Section<'_>, key: &str) {
        let finding = MISSING.at(section.header).fact("section", &*section.name);
        self.reading.push(finding.fact("name", key));
    }

    fn given(&self, section: &'a Section<'a>, key: &str) -> Option<&'a Pair<'a>> {
        let pair = self.ini.get(section, key);
        pair.filter(|pair| !pair.value.is_empty())
    }

    fn number(&mut self, section: &'a Section<'a>, key: &str) -> i128 {
        let pair = self.given(section, key);
        pair.and_then(|pair| int(&pair.value, 0)).unwrap_or(0)
    }

    fn object(&mut self, index: u32) {
        let name = format!("{index:04X}");
        let Some(section) = self.ini.section(&name) else {
            return;
        };
        let (count, compact) = (
            self.number(section, "SubNumber"),
            self.number(section, "CompactSubObj"),
        );
        let mut members = BTreeMap::new();
        if count != 0 {
            for sub in 0..255 {
                if let Some(member) = self.ini.section(&format!("{name}sub{sub:X}")) {
                    members.insert(sub, self.entry(member, (index, sub), None));
                }
            }
        } else if compact != 0 {
            let own = ReadEntry {
                data_type: Some(5),
                access: Some("ro".into()),
                mappable: Some(false),
                default: Some(Some(Read::Number(compact))),
                parameter: Some(Some(Read::Number(compact))),
                ..ReadEntry::default()
            };
            self.reading.entries.insert((index, 0), own);
            let read = Some(Read::Number(compact));
            members.insert(
                0,
                Value {
                    read,
                    span: section.header,
                },
            );
            let values = self.ini.section(&format!("{name}Value"));
            for sub in 1..=u32::try_from(compact).unwrap_or(0).min(1 << 16) {
                let own = values.and_then(|values| self.given(values, &sub.to_string()));
                if let Some(pair) = self
                    .given(section, "ParameterValue")
                    .filter(|_| values.is_none())
                {
                    let finding = MEMBERS.at(pair.span).fact("section", &*section.name);
                    self.reading
                        .push(finding.fact("what", "ParameterValue beside CompactSubObj"));
                    break;
                }
                members.insert(sub, self.entry(section, (index, sub), Some(own)));
            }
        } else {
            members.insert(0, self.entry(section, (index, 0), None));
        }
        self.objects.insert(index, members);
    }

    /// Reads one value; a sub-object of CompactSubObj has a value of its own.
    fn entry(
        &mut self,
        section: &'a Section<'a>,
        at: (u32, u32),
        compact: Option<Option<&'a Pair<'a>>>,
    ) -> Value {
        for key in ["ParameterName", "AccessType", "DataType"] {
            let there = match key {
                "ParameterName" => self.ini.get(section, key),
                _ => self.given(section, key),
            };
            if there.is_none() {
                self.missing(section, key);
            }
        }
        let data_type = self
            .given(section, "DataType")
            .and_then(|pair| int(&pair.value, 0));
        let is_basic = data_type.is_some_and(|it| limits(it).is_some());
        let mut of = |pair: Option<&'a Pair<'a>>| {
            let pair = pair.filter(|_| is_basic);
            let read = pair.map_or(Some(Read::Number(0)), |pair| {
                value(&pair.value, data_type.unwrap_or(0))
            });
            if let (None, Some(pair)) = (&read, pair) {
                unread(self.reading, pair);
            }
            let zero = matches!(data_type, Some(8 | 0x11)) && pair.is_none();
            if zero { Some(Read::Real(0.0)) } else { read }
        };
        let ini = self.ini;
        let pair = |key| {
            ini.get(section, key)
                .filter(|pair: &&Pair<'_>| !pair.value.is_empty())
        };
        let default = of(pair("DefaultValue"));
        let own = match compact {
            Some(own) => own,
            None => pair("ParameterValue"),
        };
        let parameter = if own.is_some() {
            of(own)
        } else {
            default.clone()
        };
        if compact.is_none() {
            of(pair("LowLimit").filter(|_| !matches!(data_type, Some(8 | 0x11))));
            of(pair("HighLimit").filter(|_| !matches!(data_type, Some(8 | 0x11))));
        }
        let mapping = pair("PDOMapping");
        let flag = mapping.map(|pair| int(&pair.value, 0));
        if let (Some(None), Some(pair)) = (flag, mapping) {
            unread(self.reading, pair);
        }
        let access = pair("AccessType").map(|pair| pair.value.to_lowercase());
        let span = own
            .or(pair("DefaultValue"))
            .map_or(section.header, |pair| pair.span);
        let read = parameter.clone().filter(|_| is_basic);
        let entry = ReadEntry {
            data_type,
            access,
            mappable: Some(flag.flatten().unwrap_or(0) != 0),
            default: is_basic.then_some(default),
            parameter: is_basic.then_some(parameter),
            ..ReadEntry::default()
        };
        self.reading.entries.insert(at, entry);
        Value { read, span }
    }

    fn needs(&mut self, span: Span, what: String, object: String) {
        let finding = REFERENCE.at(span).fact("what", what);
        self.reading.push(finding.fact("object", object));
    }

    /// Device type and identity, which a master compares.
    fn identity(&mut self) {
        let there = |objects: &BTreeMap<u32, BTreeMap<u32, Value>>, index: u32, sub: u32| {
            objects
                .get(&index)
                .is_some_and(|object| object.contains_key(&sub))
        };
        for (index, sub) in [(0x1000, 0), (0x1018, 1)] {
            if !there(&self.objects, index, sub) {
                self.needs(
                    Span::default(),
                    "a device".into(),
                    format!("{index:04X}h:{sub:02X}"),
                );
            }
        }
        if !self.objects.contains_key(&0x1018) {
            return;
        }
        for (section, keys) in [
            (
                "DeviceInfo",
                &["VendorNumber", "ProductNumber", "RevisionNumber"][..],
            ),
            ("DeviceComissioning", &["LSS_SerialNumber"]),
        ] {
            let Some(section) = self.ini.section(section) else {
                continue;
            };
            for key in keys {
                if let Some(pair) = self
                    .given(section, key)
                    .filter(|pair| int(&pair.value, 0).is_none())
                {
                    unread(self.reading, pair);
                }
            }
        }
    }

    fn number_of(&self, index: u32, sub: u32) -> Option<i128> {
        match &self.objects.get(&index)?.get(&sub)?.read {
            Some(Read::Number(number)) => Some(*number),
            _ => None,
        }
    }

    fn pdo(&mut self, communication: u32, mapping: u32) {
        let Some(object) = self.objects.get(&communication) else {
            return;
        };
        let span = object
            .values()
            .next()
            .map_or(Span::default(), |value| value.span);
        if !self.objects.contains_key(&mapping) {
            return self.needs(
                span,
                format!("{communication:04X}h"),
                format!("{mapping:04X}h"),
            );
        }
        for sub in 1..=self.number_of(mapping, 0).unwrap_or(0).min(255) as u32 {
            let Some(entry) = self.number_of(mapping, sub).filter(|entry| *entry != 0) else {
                continue;
            };
            let (index, member) = ((entry >> 16 & 0xFFFF) as u32, (entry >> 8 & 0xFF) as u32);
            let found = match index {
                0..0x1000 => member == 0 && is_type(index),
                _ => self
                    .objects
                    .get(&index)
                    .is_some_and(|object| object.contains_key(&member)),
            };
            if !found {
                let span = self.objects[&mapping][&sub].span;
                let what = format!("{mapping:04X}h:{sub:02X}");
                self.needs(span, what, format!("{index:04X}h:{member:02X}"));
            }
        }
    }
}

/// Returns whether the tool has a name for this type.
fn is_type(index: u32) -> bool {
    matches!(index, 1..=0xD | 0xF..=0x16 | 0x18..=0x1B)
}
