//! Reads one value: a section with a DataType.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::description::{EntryDescription, Value};
use crate::fact::Key;
use crate::finding::{Finding, Severity};
use crate::log::Log;
use crate::read::fields::Fields;
use crate::read::values;
use crate::read::words;
use crate::rules;
use crate::rules::structure::reader::{w0315_name_missing, w0342_obj_flags_reserved};
use crate::rules::text::w0109_comment_after_value;
use crate::rules::values::not_valid::{w0416_emptied, w0416_no_limits};
use crate::rules::values::reader::{
    e0402_data_type_unknown, e0405_access_type_not_valid, e0428_node_id_misspelled,
    w0404_access_type_missing, w0406_pdo_mapping_not_valid, w0407_obj_flags_not_a_number,
    w0426_standard_type_missing, w0456_file_of_number,
};
use crate::rules::values::{e0417_node_id_not_supported, shared, spelling};
use crate::scan::number;
use crate::scan::number::Note;
use crate::scan::section;
use crate::scan::section::Text;
use crate::span::{Span, Spanned};
use crate::standards::cia301;
use od_model::{Access, Address, DataType, Kind, ObjectCode};

/// Destination of the findings of one section, and its object.
pub(crate) struct Reader<'a> {
    pub(crate) address: Address,
    pub(crate) log: &'a mut Log,
}

/// Source of the type for a section without a DataType.
#[derive(Clone, Copy)]
pub(crate) enum Assumed {
    /// It is a DOMAIN.
    Domain,
    /// The type of the standard for a sub-index, or for the value of a VAR.
    Standard { sub: u8, is_whole: bool },
}

/// Unreadable values, kept as text.
pub(crate) type Unread = Vec<(String, String)>;

/// The texts that an object or entry keeps: unknown keys in file
/// order, then unreadable values by key, so that the written file is read in the same way.
pub(crate) fn extra(mut rest: Vec<(String, String)>, mut unread: Unread) -> Vec<(String, String)> {
    unread.sort();
    rest.append(&mut unread);
    rest
}

impl Reader<'_> {
    pub(crate) fn report(&mut self, finding: Finding) {
        self.log.push(finding.about(self.address));
    }

    /// ParameterName; empty if missing.
    pub(crate) fn name(&mut self, fields: &mut Fields<'_>) -> Spanned<String> {
        let place = fields.place("ParameterName").unwrap_or(fields.header);
        let name = fields.take("ParameterName").map(section::owned);
        name.unwrap_or_else(|| {
            self.report(w0315_name_missing(place));
            Spanned::from(String::new())
        })
    }

    /// A number without a type of its own: ObjectType, SubNumber, ObjFlags …
    pub(crate) fn number(&mut self, key: Key, from: &Text<'_>) -> Option<i128> {
        let mut notes = Vec::new();
        let text = number::without_comment(from, &mut notes);
        let number = number::integer(text, &mut notes)?;
        self.notes(&notes, key, from, || number.value.to_string());
        Some(number.value)
    }

    /// The entry of the fields; takes its keys and leaves the others.
    pub(crate) fn entry(
        &mut self,
        fields: &mut Fields<'_>,
        name: Spanned<String>,
        assumed: Assumed,
    ) -> (EntryDescription, Unread) {
        let mut unread = Vec::new();
        let data_type = match self.data_type(fields, &assumed, &mut unread) {
            None if unread.is_empty() => self.assumed(assumed, fields.header).map(Spanned::from),
            given => given,
        };
        self.files(fields, data_type);
        let access = self.access(fields, &mut unread);
        let mappable = self.mappable(fields, &mut unread);
        let mut value = |key, low| self.value(fields, key, data_type, low, &mut unread);
        let default = value(Key::DefaultValue, None);
        let low = value(Key::LowLimit, None);
        let high = value(Key::HighLimit, low.as_ref().map(|low| &low.value));
        let parameter = value(Key::ParameterValue, None);
        let entry = EntryDescription {
            name,
            data_type,
            access,
            mappable,
            default,
            low,
            high,
            parameter,
            group: fields.group,
            capacity: None,
            flags: self.flags(fields, &mut unread),
            extra: Vec::new(),
            span: fields.header,
        };
        (entry, unread)
    }

    /// Reports the files of a value that is not a DOMAIN. The keys are kept with the unknown ones.
    fn files(&mut self, fields: &Fields<'_>, data_type: Option<Spanned<DataType>>) {
        let given = data_type.map(|given| given.value);
        if let Some(data_type) = given.filter(|given| *given != DataType::Domain) {
            for key in ["UploadFile", "DownloadFile"] {
                // A generator may write the key without a file.
                if let Some(place) = fields.place(key).filter(|_| fields.has(key)) {
                    self.report(w0456_file_of_number(place, key, data_type));
                }
            }
        }
    }

    /// The type of a section without one.
    fn assumed(&mut self, assumed: Assumed, header: Span) -> Option<DataType> {
        match assumed {
            // An object of code DOMAIN may leave its type out.
            Assumed::Domain => Some(DataType::Domain),
            Assumed::Standard { sub, is_whole } => {
                let found = cia301::data_type(self.address.index, sub, is_whole)?;
                self.report(w0426_standard_type_missing(header, found));
                Some(found)
            }
        }
    }

    /// The value of a key, if the section has it; an unreadable value is reported and
    /// kept as text.
    pub(crate) fn keyed<T>(
        &mut self,
        fields: &mut Fields<'_>,
        unread: &mut Unread,
        key: Key,
        read: impl FnOnce(&mut Self, &Text<'_>) -> Option<T>,
        not_read: impl FnOnce(&Text<'_>) -> Finding,
    ) -> Option<Spanned<Option<T>>> {
        let given = fields.take(key.name())?;
        let value = read(self, &given);
        if value.is_none() {
            self.report(not_read(&given));
            unread.push((key.name().into(), given.value.into_owned()));
        }
        Some(Spanned::new(value, given.span))
    }

    /// A value written as a number, or as a word of another tool.
    fn coded<T>(
        &mut self,
        key: Key,
        given: &Text<'_>,
        of: impl FnOnce(i128) -> Option<T>,
        of_word: impl FnOnce(&str) -> Option<T>,
        right: impl FnOnce(&T) -> String,
    ) -> Option<T> {
        self.number(key, given).and_then(of).or_else(|| {
            let value = of_word(given)?;
            self.word(key, given, &right(&value));
            Some(value)
        })
    }

    fn data_type(
        &mut self,
        fields: &mut Fields<'_>,
        assumed: &Assumed,
        unread: &mut Unread,
    ) -> Option<Spanned<DataType>> {
        let of = |code: i128| DataType::from_code(u16::try_from(code).ok()?);
        let right = |data_type: &DataType| format!("0x{:04X}", data_type.code());
        let key = Key::DataType;
        let read = |reader: &mut Self, given: &Text<'_>| {
            reader.coded(key, given, of, words::data_type, right)
        };
        let standard = match assumed {
            Assumed::Domain => Some(DataType::Domain),
            Assumed::Standard { sub, is_whole } => {
                cia301::data_type(self.address.index, *sub, *is_whole)
            }
        };
        let wrong = |given: &Text<'_>| e0402_data_type_unknown(given, standard);
        let found = self.keyed(fields, unread, key, read, wrong)?;
        Some(Spanned::new(found.value?, found.span))
    }

    fn access(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> Spanned<Access> {
        let read = |reader: &mut Self, given: &Text<'_>| reader.access_word(given);
        let key = Key::AccessType;
        let Address { index, sub } = self.address;
        let standard = cia301::of(index).and_then(|standard| standard.value(sub));
        let standard = standard.map(|value| value.access);
        let wrong = |given: &Text<'_>| e0405_access_type_not_valid(given, standard);
        let Some(found) = self.keyed(fields, unread, key, read, wrong) else {
            self.report(w0404_access_type_missing(fields.header));
            return Spanned::from(Access::Ro);
        };
        Spanned::new(found.value.unwrap_or(Access::Ro), found.span)
    }

    fn access_word(&mut self, given: &Text<'_>) -> Option<Access> {
        let mut notes = Vec::new();
        let word = number::without_comment(given, &mut notes);
        let known = Access::ALL.into_iter();
        let mut known = known.filter(|access| word.eq_ignore_ascii_case(access.name()));
        let access = known.next().or_else(|| {
            let access = words::access(given)?;
            self.word(Key::AccessType, given, access.name());
            Some(access)
        })?;
        self.notes(&notes, Key::AccessType, given, || access.name().into());
        Some(access)
    }

    fn mappable(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> Spanned<bool> {
        let of = |number| match number {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        };
        let right = |mappable: &bool| u8::from(*mappable).to_string();
        let key = Key::PdoMapping;
        let read = |reader: &mut Self, given: &Text<'_>| {
            reader.coded(key, given, of, words::mappable, right)
        };
        match self.keyed(fields, unread, key, read, w0406_pdo_mapping_not_valid) {
            Some(found) => Spanned::new(found.value.unwrap_or(false), found.span),
            None => Spanned::from(false),
        }
    }

    /// ObjectType, as a number or as a word.
    pub(crate) fn object_code(&mut self, given: &Text<'_>) -> Option<ObjectCode> {
        let of = |code: i128| ObjectCode::from_code(u8::try_from(code).ok()?);
        let right = |code: &ObjectCode| format!("0x{:X}", code.code());
        self.coded(Key::ObjectType, given, of, words::object_code, right)
    }

    /// Reports a word that is read as this value.
    fn word(&mut self, key: Key, given: &Text<'_>, right: &str) {
        self.report(spelling::read_as(&rules::W0424, key, given, right));
    }

    /// ObjFlags; 0 if missing.
    pub(crate) fn flags(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> u32 {
        let key = Key::ObjFlags;
        let read = |reader: &mut Self, given: &Text<'_>| {
            let flags = u32::try_from(reader.number(key, given)?).ok()?;
            if let Some(finding) = w0342_obj_flags_reserved(given, flags) {
                reader.report(finding);
            }
            Some(flags)
        };
        let found = self.keyed(fields, unread, key, read, w0407_obj_flags_not_a_number);
        found.and_then(|found| found.value).unwrap_or(0)
    }

    fn value(
        &mut self,
        fields: &mut Fields<'_>,
        key: Key,
        data_type: Option<Spanned<DataType>>,
        low: Option<&Value>,
        unread: &mut Unread,
    ) -> Option<Spanned<Value>> {
        let given = fields.take(key.name())?;
        if let Some(data_type) = data_type
            && matches!(data_type.kind(), Kind::Text | Kind::Bytes)
            && matches!(key, Key::LowLimit | Key::HighLimit)
        {
            self.report(w0416_no_limits(key, &given, data_type));
            unread.push((key.name().into(), given.value.into_owned()));
            return None;
        }
        let value = self.typed(key, &given, data_type, low);
        if value.is_none() {
            unread.push((key.name().into(), given.value.into_owned()));
        }
        value
    }

    /// The value of a key by its type; an invalid one is reported. A HighLimit is read
    /// together with the LowLimit: between 0 and FFh of an INTEGER8, FFh is not -1.
    pub(crate) fn typed(
        &mut self,
        key: Key,
        given: &Text<'_>,
        data_type: Option<Spanned<DataType>>,
        low: Option<&Value>,
    ) -> Option<Spanned<Value>> {
        // Without a type it has no value; this was reported, or the checks report it.
        let data_type = data_type.filter(|t| t.kind() != Kind::Record)?;
        let mut notes = Vec::new();
        match values::value(given, *data_type, &mut notes) {
            Some(mut value) => {
                if let (Some(Value::Signed(low @ 0..)), Value::Signed(high)) = (low, &value)
                    && high < low
                    && notes.contains(&Note::TwosComplement)
                {
                    notes.retain(|note| *note != Note::TwosComplement);
                    value = values::pattern(given)?;
                }
                let canonical = || values::text(&value, Some(*data_type));
                self.notes(&notes, key, given, canonical);
                Some(Spanned::new(value, given.span))
            }
            None => {
                self.report(unfit(key, given, data_type));
                None
            }
        }
    }

    /// Reports a value that odkit can read but other tools may not.
    fn notes(
        &mut self,
        notes: &[Note],
        key: Key,
        given: &Text<'_>,
        canonical: impl Fn() -> String,
    ) {
        for note in notes {
            let rule = match note {
                Note::Comment => {
                    let value = number::without_comment(given, &mut Vec::new());
                    self.report(w0109_comment_after_value(key, given, value));
                    continue;
                }
                Note::Octal => &rules::I0408,
                Note::NotOctal => &rules::W0409,
                Note::TwosComplement => &rules::I0410,
                Note::NodeId => &rules::I0411,
                Note::Characters => &rules::W0419,
                Note::Suffix => &rules::W0420,
                Note::BareHex => &rules::W0422,
                Note::Comma => &rules::W0423,
                Note::Word => &rules::W0421,
            };
            let finding = spelling::read_as(rule, key, given, &canonical());
            // Most tools read another case or order; no tool reads another name.
            let is_name = || given.to_ascii_uppercase().contains("$NODEID");
            self.report(if *note == Note::NodeId && !is_name() {
                finding.severity_of(Severity::Error)
            } else {
                finding
            });
        }
    }
}

/// The finding about a value that is invalid for its type.
fn unfit(key: Key, given: &Text<'_>, data_type: Spanned<DataType>) -> Finding {
    let formula = given.to_ascii_uppercase().contains("$NODEID");
    if formula && !data_type.holds_node_id() {
        return e0417_node_id_not_supported::finding(key, &*given.value, given.span, data_type);
    }
    let rule = match key {
        Key::DefaultValue => &rules::E0412,
        Key::ParameterValue => &rules::E0413,
        _ => &rules::W0416,
    };
    let meant = number::meant_node_id(given).filter(|_| data_type.holds_node_id());
    if let Some(offset) = meant {
        return e0428_node_id_misspelled(key, given, offset);
    }
    let finding = if formula {
        shared::unfit_formula(rule, key, given, data_type)
    } else {
        shared::unfit(rule, key, &*given.value, given.span, data_type)
    };
    match key {
        Key::LowLimit | Key::HighLimit => w0416_emptied(finding),
        _ => finding,
    }
}
