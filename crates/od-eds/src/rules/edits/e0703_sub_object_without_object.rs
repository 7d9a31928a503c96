use crate::fact::Fact;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::Spanned;
pub(crate) static RULE: Rule = Rule {
    code: "E0703",
    severity: Error,
    title: "added sub-object has no object",
    why: "A sub-object belongs to an object, which has to exist before it. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000sub1 { name = \"Order\"; type = u8 }",
    says: "`{target}` needs object {object}, which does not exist",
    help: "write `add 0x{object:04X} {{ code = record; name = \"…\" }}` first",
    ..Rule::NEW
};

/// The finding about an `add` of a sub-object without an object.
pub(crate) fn finding(target: &Spanned<Target>) -> Finding {
    target
        .named(&RULE, target.span)
        .fact("object", Fact::Index(target.index))
}
