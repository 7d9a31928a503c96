use crate::fact::{Fact, Key};
use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::{Span, Spanned};
use od_model::DataType;

pub(crate) static RULE: Rule = Rule {
    code: "E0708",
    severity: Error,
    title: "value of the base is not valid for the new type",
    why: "An edit that changes the type also has to change the values that are not valid for it. odkit leaves the value out.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1000 { type = u8 }          // its default is 0x20196",
    says: "{key} `{given}` of the base is not a valid {type}",
    help: "write {key} too: {form}, or `none`",
    ..Rule::NEW
};

/// The finding about a value that is not valid for the type that an edit gives.
pub(crate) fn finding(
    target: &Spanned<Target>,
    at: Span,
    key: Key,
    given: &str,
    data_type: DataType,
) -> Finding {
    target
        .finding(&RULE, at)
        .key(key)
        .fact("given", given)
        .fact("type", data_type)
        .fact("form", Fact::FormOf(data_type))
}
