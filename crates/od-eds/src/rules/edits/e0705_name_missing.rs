use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::Spanned;
pub(crate) static RULE: Rule = Rule {
    code: "E0705",
    severity: Error,
    title: "added object has no name",
    why: "The handle in Rust gets its name from the name of the object.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { type = u16 }",
    says: "`add {target}` lacks {ParameterName}",
    help: "write `{ParameterName=\"…\"}`",
    ..Rule::NEW
};

/// The finding about an `add` without a name.
pub(crate) fn finding(target: &Spanned<Target>) -> Finding {
    target.named(&RULE, target.span)
}
