//! The words of a macro call, `object_dictionary!`, for the macro and for an editor.

use alloc::format;
use alloc::string::String;

use od_model::{DataType, Group, Kind, ObjectCode};

use crate::catalogue::{Eds, Vocabulary};
use crate::fact::{Fact, Key};
use crate::fix::Applicability;
use crate::patch::Target;

/// The words for the fields of a row.
pub const FIELDS: [&str; 10] = [
    "name", "type", "access", "default", "low", "high", "mappable", "save", "code", "capacity",
];

/// The words for the types; the macro also accepts the other names of CiA 301.
pub const TYPES: [(&str, DataType); 25] = [
    ("bool", DataType::Boolean),
    ("u8", DataType::Unsigned8),
    ("u16", DataType::Unsigned16),
    ("u32", DataType::Unsigned32),
    ("u64", DataType::Unsigned64),
    ("i8", DataType::Integer8),
    ("i16", DataType::Integer16),
    ("i32", DataType::Integer32),
    ("i64", DataType::Integer64),
    ("f32", DataType::Real32),
    ("f64", DataType::Real64),
    ("str", DataType::VisibleString),
    ("UNSIGNED24", DataType::Unsigned24),
    ("UNSIGNED40", DataType::Unsigned40),
    ("UNSIGNED48", DataType::Unsigned48),
    ("UNSIGNED56", DataType::Unsigned56),
    ("INTEGER24", DataType::Integer24),
    ("INTEGER40", DataType::Integer40),
    ("INTEGER48", DataType::Integer48),
    ("INTEGER56", DataType::Integer56),
    ("TIME_OF_DAY", DataType::TimeOfDay),
    ("TIME_DIFFERENCE", DataType::TimeDifference),
    ("OCTET_STRING", DataType::OctetString),
    ("UNICODE_STRING", DataType::UnicodeString),
    ("DOMAIN", DataType::Domain),
];

/// The words for the groups of parameters that 1010h saves.
pub const GROUPS: [(&str, Group); 4] = [
    ("communication", Group::Communication),
    ("application", Group::Application),
    ("manufacturer", Group::Manufacturer),
    ("none", Group::None),
];

/// The words for the object codes.
pub const CODES: [(&str, ObjectCode); 4] = [
    ("var", ObjectCode::Var),
    ("array", ObjectCode::Array),
    ("record", ObjectCode::Record),
    ("domain", ObjectCode::Domain),
];

fn word<T: Copy + PartialEq>(words: &[(&'static str, T)], value: T) -> Option<&'static str> {
    let mut all = words.iter();
    all.find(|(_, known)| *known == value)
        .map(|(word, _)| *word)
}

/// The words of a macro call: `low = 5` in the row of an object.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row;

impl Vocabulary for Row {
    fn key(&self, key: Key) -> &'static str {
        match key {
            Key::ParameterName => "`name`",
            Key::ObjectType => "`code`",
            Key::DataType => "`type`",
            Key::AccessType => "`access`",
            Key::PdoMapping => "`mappable`",
            Key::DefaultValue => "`default`",
            Key::LowLimit => "`low`",
            Key::HighLimit => "`high`",
            Key::StorageLocation => "`save`",
            Key::Capacity => "`capacity`",
            other => other.name(),
        }
    }

    fn set(&self, key: Key, value: &str) -> String {
        let field = self.key(key).trim_matches('`');
        match (key, value) {
            (_, "") => field.into(),
            (Key::PdoMapping, "0") => format!("{field} = false"),
            (Key::PdoMapping, "1") => format!("{field} = true"),
            _ => format!("{field} = {value}"),
        }
    }

    fn fix(&self, _: Applicability) -> &'static str {
        ""
    }

    fn form_of(&self, data_type: DataType) -> String {
        match data_type.kind() {
            Kind::Boolean => "`true` or `false`".into(),
            Kind::Text => "a text such as `\"a\"`".into(),
            Kind::Bytes => "bytes such as `b\"\\x12\\xAB\"`".into(),
            _ => Eds.form_of(data_type),
        }
    }

    fn written(&self, fact: &Fact) -> Option<String> {
        let word = match fact {
            Fact::Type(data_type) => word(&TYPES, *data_type),
            Fact::Code(code) => word(&CODES, *code),
            _ => None,
        };
        word.map(Into::into)
    }

    fn section(&self, index: u16, sub: Option<u8>) -> String {
        format!("a row `add {} {{ … }}`", Target { index, sub })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The macro and an editor use the same words, which differ from those of an EDS.
    #[test]
    fn a_call_has_its_own_words() {
        assert_eq!(Row.set(Key::PdoMapping, "0"), "mappable = false");
        assert_eq!(Row.set(Key::LowLimit, "5"), "low = 5");
        assert_eq!(Row.form_of(DataType::Boolean), "`true` or `false`");
        let fact = Fact::Type(DataType::Unsigned24);
        assert_eq!(Row.written(&fact).as_deref(), Some("UNSIGNED24"));
    }
}
