//! Writes the canonical text of a description.

use alloc::collections::BTreeMap;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;

use crate::description::{Description, EntryDescription, ObjectDescription, Section, Value};
use crate::read::{fields, values};
use crate::scan::either;
use crate::scan::names::List;
use crate::span::Spanned;
use od_model::Group;

/// Returns the text of a description, without additions.
///
/// Sections that describe no object come first, unchanged; the three lists are made from the
/// objects; CompactSubObj and CompactPDO are expanded. The text gives the same description again.
/// For a file that other tools read, use [`canonical`](crate::canonical()).
///
/// Reals are decimal, as vendors write them; only Lely expects the bit pattern.
pub fn write(description: &Description) -> String {
    text(&description.sections, &description.objects, |object| {
        object.sub_number
    })
}

/// The text of sections and objects; `sub_number` is what each object has as SubNumber.
pub(super) fn text(
    sections: &[Section],
    objects: &BTreeMap<u16, ObjectDescription>,
    sub_number: fn(&ObjectDescription) -> Option<Spanned<u32>>,
) -> String {
    let mut out = Text(String::new());
    for section in sections {
        out.section(&section.name);
        for (key, value) in &section.pairs {
            out.pair(key, value);
        }
    }
    for list in List::ALL {
        let indices: Vec<u16> = objects
            .keys()
            .copied()
            .filter(|index| List::of(*index) == list)
            .collect();
        out.section(list.name());
        out.pair("SupportedObjects", &indices.len().to_string());
        for (number, index) in (1..).zip(&indices) {
            out.line(format_args!("{number}=0x{index:04X}"));
        }
        for index in indices {
            if let Some(object) = objects.get(&index) {
                out.object(index, object, sub_number(object));
            }
        }
    }
    out.0
}

/// The sections of one object.
pub(crate) fn object(index: u16, object: &ObjectDescription) -> String {
    let mut out = Text(String::new());
    out.object(index, object, object.sub_number);
    out.0
}

struct Text(String);

impl Text {
    fn line(&mut self, line: core::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.0.write_fmt(line);
        self.0.push('\n');
    }

    fn section(&mut self, name: &str) {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
        self.0.push('[');
        self.one_line(name);
        self.0.push_str("]\n");
    }

    fn pair(&mut self, key: &str, value: &str) {
        self.one_line(key);
        self.0.push('=');
        self.one_line(value);
        self.0.push('\n');
    }

    /// A text of a patch may contain line ends, which the format cannot express; they become
    /// blanks.
    fn one_line(&mut self, text: &str) {
        match either(text, [b'\n', b'\r']) {
            Some(_) => self.0.push_str(&text.replace(['\n', '\r'], " ")),
            None => self.0.push_str(text),
        }
    }

    /// Writes a field, unless `extra` has a text for it that could not be read.
    fn field(&mut self, key: &str, value: &str, extra: &[(String, String)]) {
        if !extra.iter().any(|(k, _)| k.eq_ignore_ascii_case(key)) {
            self.pair(key, value);
        }
    }

    fn object(&mut self, index: u16, object: &ObjectDescription, sub_number: Option<Spanned<u32>>) {
        self.section(&alloc::format!("{index:04X}"));
        let code = alloc::format!("0x{:X}", object.code.code());
        if !object.code.has_members() {
            let entry = object.entries.get(&0);
            self.pair("ParameterName", &object.name);
            let extra = entry.map_or(&[][..], |entry| &entry.extra);
            self.field("ObjectType", &code, extra);
            if let Some(number) = &sub_number {
                self.field("SubNumber", &number.to_string(), extra);
            }
            if let Some(entry) = entry {
                self.entry(entry, None);
            }
            return;
        }
        let extra = &object.extra;
        self.pair("ParameterName", &object.name);
        self.field("ObjectType", &code, extra);
        let number = sub_number.map_or(object.entries.len() as u32, |number| number.value);
        self.field("SubNumber", &number.to_string(), extra);
        if object.flags != 0 {
            self.field("ObjFlags", &alloc::format!("0x{:X}", object.flags), extra);
        }
        for (key, value) in extra {
            self.pair(key, value);
        }
        let group = fields::kept(extra).and_then(|(_, group)| group);
        for (sub, entry) in &object.entries {
            self.section(&alloc::format!("{index:04X}sub{sub:X}"));
            self.pair("ParameterName", &entry.name);
            self.field("ObjectType", "0x7", &entry.extra);
            self.entry(entry, group);
        }
    }

    /// The keys of a value; `inherited` is the group that its object gives to its sub-objects.
    fn entry(&mut self, entry: &EntryDescription, inherited: Option<Group>) {
        let extra = &entry.extra;
        if let Some(group) = entry.group.map(|group| group.value)
            && fields::kept(extra).is_none()
            && Some(group) != inherited
        {
            self.pair(fields::STORAGE, fields::location(group));
        }
        let data_type = entry.data_type.map(|t| t.value);
        if let Some(data_type) = data_type {
            let code = alloc::format!("0x{:04X}", data_type.code());
            self.field("DataType", &code, extra);
        }
        self.value("LowLimit", entry, &entry.low);
        self.value("HighLimit", entry, &entry.high);
        self.field("AccessType", entry.access.name(), extra);
        self.value("DefaultValue", entry, &entry.default);
        let mappable = if *entry.mappable { "1" } else { "0" };
        self.field("PDOMapping", mappable, extra);
        self.value("ParameterValue", entry, &entry.parameter);
        if entry.flags != 0 {
            self.field("ObjFlags", &alloc::format!("0x{:X}", entry.flags), extra);
        }
        for (key, value) in extra {
            self.pair(key, value);
        }
    }

    fn value(&mut self, key: &str, entry: &EntryDescription, value: &Option<Spanned<Value>>) {
        if let Some(value) = value {
            let data_type = entry.data_type.map(|t| t.value);
            self.field(key, &values::text(value, data_type), &entry.extra);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_canonical_text() {
        let text = "[Mine]\nOwn=kept\n[comments]\nLines=7\nLine1=one\nLine3=three\n\
            [DEVICECOMMISSIONING]\nnodeid=0x05\nBaudrate=\n[FileInfo]\nfilename : x.eds\n\
            [dummyusage]\ndummy0005=0x1\n[DeviceInfo]\nvendornumber=020\nNrOfRxPDO=010\n\
            ProductNumber=\n[2000]\nparametername=Gain\nobjecttype=8\n\
            datatype=7\naccesstype=RW\ndefaultvalue=0x180+$nodeid\ncompactsubobj=1\n[2001]\n\
            ;StorageLocation=PERSIST_APP\nParameterName=Speed\nDataType=3\nHighLimit=0x7F\n\
            LowLimit=0xFF80\nAccessType=rww\nPDOMapping=1\nDefaultValue=red\nMine=1\n[1000]\n";
        let written = crate::canonical(&crate::parse(text).description);
        let expected = "[FileInfo]\nFileName=x.eds\nEDSVersion=4.0\n\n\
            [DeviceInfo]\nVendorNumber=0x00000010\nNrOfRXPDO=8\nNrOfTXPDO=0\n\n\
            [DummyUsage]\nDummy0001=0\nDummy0002=0\nDummy0003=0\nDummy0004=0\n\
            Dummy0005=1\nDummy0006=0\nDummy0007=0\n\n\
            [Comments]\nLines=2\nLine1=one\nLine2=three\n\n\
            [DeviceComissioning]\nNodeID=5\n\n\
            [Mine]\nOwn=kept\n\n\
            [MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n\n\
            [1000]\nParameterName=\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nPDOMapping=0\n\n\
            [OptionalObjects]\nSupportedObjects=0\n\n\
            [ManufacturerObjects]\nSupportedObjects=2\n1=0x2000\n2=0x2001\n\n\
            [2000]\nParameterName=Gain\nObjectType=0x8\nSubNumber=2\n\n\
            [2000sub0]\nParameterName=NrOfObjects\nObjectType=0x7\nDataType=0x0005\n\
            AccessType=ro\nDefaultValue=1\nPDOMapping=0\n\n\
            [2000sub1]\nParameterName=Gain1\nObjectType=0x7\nDataType=0x0007\n\
            AccessType=rw\nDefaultValue=$NODEID+0x180\nPDOMapping=0\n\n\
            [2001]\nParameterName=Speed\nObjectType=0x7\n;StorageLocation=PERSIST_APP\n\
            DataType=0x0003\nLowLimit=-128\nHighLimit=127\nAccessType=rww\nPDOMapping=1\n\
            Mine=1\nDefaultValue=red\n";
        assert_eq!(written, expected);
        let again = crate::parse(&written).description;
        assert_eq!(again.objects, crate::parse(text).description.objects);
        assert_eq!(crate::canonical(&again), written);
        let plain = crate::parse(text).description;
        assert_eq!(crate::parse(&write(&plain)).description, plain);
    }

    #[test]
    fn the_storage_of_an_object_and_other_words_are_kept() {
        let text = "[2000]\nParameterName=a\nObjectType=0x9\nSubNumber=3\n;StorageLocation=PERSIST_COMM\n\n\
            [2000sub0]\nParameterName=n\nObjectType=0x7\nDataType=0x0005\nAccessType=ro\nDefaultValue=2\nPDOMapping=0\n\n\
            [2000sub1]\nParameterName=b\nObjectType=0x7\n;StorageLocation=RAM\nDataType=0x0005\nAccessType=rw\nPDOMapping=0\n\n\
            [2000sub2]\nParameterName=c\nObjectType=0x7\nDataType=0x0005\nAccessType=rw\nPDOMapping=0\n;StorageLocation=ROM\n\n\
            [2001]\nParameterName=d\nObjectType=0x7\nDataType=0x0005\nAccessType=rw\nPDOMapping=0\n;StorageLocation=EEPROM\n";
        let description = crate::parse(text).description;
        let written = write(&description);
        assert!(written.ends_with(text), "{written}");
        assert_eq!(
            crate::parse(&written).description.objects,
            description.objects
        );
        let groups = |sub| {
            description.objects[&0x2000].entries[&sub]
                .group
                .map(|group| group.value)
        };
        assert_eq!(groups(0), Some(Group::Communication));
        assert_eq!(
            (groups(1), groups(2)),
            (Some(Group::None), Some(Group::None))
        );
    }

    #[test]
    fn line_ends_of_a_patch_do_not_break_the_text() {
        let mut description = Description::default();
        let mut entry = EntryDescription::new("two\nlines", od_model::DataType::VisibleString);
        entry.default = Some(Spanned::from(Value::Text("a\r\n[b]".into())));
        description
            .objects
            .insert(0x2000, ObjectDescription::var(entry));
        let again = crate::parse(&write(&description)).description;
        let entry = &again.objects[&0x2000].entries[&0];
        assert_eq!(entry.name.value, "two lines");
        let text = Value::Text("a  [b]".into());
        assert_eq!(entry.default, Some(Spanned::from(text)));
    }
}
