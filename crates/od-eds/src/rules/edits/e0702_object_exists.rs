use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::Spanned;
pub(crate) static RULE: Rule = Rule {
    code: "E0702",
    severity: Error,
    title: "added object already exists",
    why: "A variant adds only objects that its base lacks. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "add 0x1017 { name = \"Heartbeat\"; type = u16 }   // the EDS has 1017h",
    says: "{object} already exists",
    help: "write `modify {target} {{ … }}` to change it",
    ..Rule::NEW
};

/// The finding about an `add` of an object or a sub-object that the description has.
pub(crate) fn finding(target: &Spanned<Target>) -> Finding {
    target
        .named(&RULE, target.span)
        .fact("object", target.shown())
}
