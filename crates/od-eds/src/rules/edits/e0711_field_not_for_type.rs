use crate::fact::Key;
use crate::finding::{Finding, Form, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::{Span, Spanned};
use od_model::DataType;

pub(crate) static RULE: Rule = Rule {
    code: "E0711",
    severity: Error,
    title: "field does not apply to the type",
    why: "A PDO carries values of fixed length, and only strings and DOMAINs have room of a length that is chosen. odkit ignores the field.",
    source: "odkit, object_dictionary!; CiA 301, data types and PDO mapping parameter",
    example: "add 0x2000 { name = \"Order\"; type = u8; capacity = 8 }",
    says: "{type} has a fixed length, and no {key}",
    help: "remove {key}, or write another type, such as `{DataType=OCTET_STRING}`",
    also: &[MAPPABLE],
    ..Rule::NEW
};

/// A string or DOMAIN that is to be mapped.
const MAPPABLE: Form = Form {
    says: "{type} has no fixed length and cannot be mapped into a PDO",
    help: "write `{PDOMapping=0}`, or a type of fixed length",
};

/// The finding about `capacity` of a number.
pub(crate) fn capacity(target: &Spanned<Target>, at: Span, data_type: DataType) -> Finding {
    let finding = target.finding(&RULE, at).key(Key::Capacity);
    finding.fact("type", data_type)
}

/// The finding about a mappable value without a fixed length.
pub(crate) fn mappable(target: &Spanned<Target>, at: Span, data_type: DataType) -> Finding {
    let finding = target.finding(&RULE, at).key(Key::PdoMapping);
    finding.fact("type", data_type).form(&MAPPABLE)
}
