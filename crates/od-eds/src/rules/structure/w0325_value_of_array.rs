use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;
use od_model::ObjectCode;

pub(crate) static RULE: Rule = Rule {
    code: "W0325",
    severity: Warning,
    title: "ARRAY or RECORD has a key of a value",
    why: "Only sub-objects have a value. A tool may read the object as a VAR. odkit keeps the key and ignores it.",
    source: "CiA 306-1, object sections",
    says: "{key} is not a key of an object that is {code}",
    help: "move the line to the sections of the sub-objects, or remove it",
    ..Rule::NEW
};

/// Keys that belong to the sub-objects.
pub(crate) const KEYS: [Key; 6] = [
    Key::DataType,
    Key::AccessType,
    Key::PdoMapping,
    Key::DefaultValue,
    Key::LowLimit,
    Key::HighLimit,
];

/// The finding about such a key.
pub(crate) fn finding(place: Span, key: Key, code: ObjectCode) -> Finding {
    RULE.at(place).key(key).fact("code", code)
}
