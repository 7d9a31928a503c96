use crate::fact::{Fact, Key};
use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::{Span, Spanned};

pub(crate) static RULE: Rule = Rule {
    code: "E0710",
    severity: Error,
    title: "value of an object with sub-objects",
    why: "Type, access, default and limits belong to the sub-objects. odkit ignores the value.",
    source: "odkit, object_dictionary!",
    example: "modify 0x1018 { default = 5 }        // a RECORD has no value",
    says: "{object} has sub-objects, and {key} belongs to one of them",
    help: "write the sub-object, such as `0x{object:04X}sub1`",
    ..Rule::NEW
};

/// The finding about a field of a value at an object with sub-objects.
pub(crate) fn finding(target: &Spanned<Target>, at: Span, key: Key) -> Finding {
    target
        .finding(&RULE, at)
        .key(key)
        .fact("object", Fact::Index(target.index))
}
