use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::Spanned;
use od_model::DataType;

pub(crate) static RULE: Rule = Rule {
    code: "E0706",
    severity: Error,
    title: "added value has no type",
    why: "The handle in Rust gets its type from the type of the value.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { name = \"Gain\" }",
    says: "`add {target}` lacks {DataType}",
    help: "write `{DataType={type}}` ({type}), or another type",
    ..Rule::NEW
};

/// The finding about an `add` without a type.
pub(crate) fn finding(target: &Spanned<Target>) -> Finding {
    target
        .named(&RULE, target.span)
        .fact("type", DataType::Unsigned16)
}
