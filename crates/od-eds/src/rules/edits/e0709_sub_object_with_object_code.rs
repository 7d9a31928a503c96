use crate::fact::Fact;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::{Span, Spanned};
pub(crate) static RULE: Rule = Rule {
    code: "E0709",
    severity: Error,
    title: "sub-object with an object code",
    why: "Only an object has an object code; a sub-object is always a VAR. odkit ignores the code.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1018sub1 { code = var }",
    says: "`{target}` is a sub-object and has no {ObjectType}",
    help: "write `0x{object:04X} {{ {ObjectType=record} }}`",
    ..Rule::NEW
};

/// The finding about an object code at a sub-object.
pub(crate) fn finding(target: &Spanned<Target>, at: Span) -> Finding {
    target
        .named(&RULE, at)
        .fact("object", Fact::Index(target.index))
}
