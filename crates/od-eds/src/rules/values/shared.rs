//! Parts of several rules about values: the values of an entry, and values that do not fit their
//! type.

use alloc::format;
use alloc::string::String;

use od_model::{DataType, Kind};

use crate::description::Value;
use crate::fact::{Fact, Key};
use crate::finding::{Finding, Form, Rule};
use crate::scan::section::Text;
use crate::span::{Span, Spanned};
use crate::subject::Entry;

/// A part of the numbers of an object that a document reserves.
pub(crate) enum Reserved {
    /// The bits of this mask.
    Bits(u64),
    /// The number is one of those that are reserved, or not.
    Number(bool),
}

impl Reserved {
    /// Returns whether this number has such a bit, or is reserved.
    pub(crate) const fn has(&self, number: u64) -> bool {
        match self {
            Self::Bits(mask) => number & *mask != 0,
            Self::Number(is) => *is,
        }
    }

    /// The value without the reserved bits, as a file writes it.
    pub(crate) fn cleared(&self, value: &Value) -> Option<String> {
        match (self, value) {
            (Self::Bits(mask), Value::NodeId(offset)) => {
                Some(format!("$NODEID+0x{:X}", u64::from(*offset) & !mask))
            }
            (Self::Bits(mask), Value::Unsigned(number)) => Some(format!("0x{:X}", number & !mask)),
            _ => None,
        }
    }
}

/// The label at a DataType.
pub(crate) const DECLARED: &str = "declared as {type} here";

/// The sentence for a value that is not valid for its type.
pub(crate) const NOT_VALID: &str = "{key} `{given}` is not a valid {type}";

/// The sentences for a type that only a RECORD has.
pub(crate) const WHOLE: Form = Form {
    says: "{type} is the type of a RECORD, not of a value",
    help: "write the type of a single value, such as `{DataType={right}}` ({right})",
};

/// The help for a formula that is not valid.
pub(super) const FORMULA: Form = Form {
    help: "write `$NODEID` and a number, such as `$NODEID+0x180`",
    ..Form::OWN
};

/// The type of an entry's value; `None` if no value can have it.
pub(super) fn data_type(entry: &Entry<'_>) -> Option<Spanned<DataType>> {
    entry
        .data_type
        .filter(|data_type| data_type.kind() != Kind::Record)
}

pub(super) fn values<'a>(
    entry: &Entry<'a>,
) -> impl Iterator<Item = (Key, &'a Spanned<Value>)> + use<'a> {
    let entry = entry.entry;
    let values = [
        (Key::DefaultValue, &entry.default),
        (Key::ParameterValue, &entry.parameter),
        (Key::LowLimit, &entry.low),
        (Key::HighLimit, &entry.high),
    ];
    let values = values.into_iter();
    values.filter_map(|(key, value)| Some((key, value.as_ref()?)))
}

/// The finding about a value that is not valid for its type, with the text of the value.
pub(crate) fn unfit(
    rule: &'static Rule,
    key: Key,
    given: impl Into<Fact>,
    span: Span,
    data_type: Spanned<DataType>,
) -> Finding {
    rule.at(span)
        .key(key)
        .fact("given", given)
        .fact("type", *data_type)
        .fact("form", Fact::FormOf(*data_type))
        .related(data_type.span, DECLARED)
}

/// The finding about a formula that is not valid.
pub(crate) fn unfit_formula(
    rule: &'static Rule,
    key: Key,
    given: &Text<'_>,
    data_type: Spanned<DataType>,
) -> Finding {
    let finding = rule.at(given.span).form(&FORMULA).key(key);
    let finding = finding
        .fact("given", &*given.value)
        .fact("type", *data_type);
    finding.related(data_type.span, DECLARED)
}
