use crate::fact::Fact;
use crate::finding::{Finding, Form, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::Spanned;
use od_model::ObjectCode;

pub(crate) static RULE: Rule = Rule {
    code: "E0704",
    severity: Error,
    title: "object has no sub-objects",
    why: "Only an ARRAY or a RECORD has sub-objects. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "add 0x1017sub1 { name = \"Second\"; type = u16 }   // 1017h is a VAR",
    says: "{object} has object code {code} and no sub-objects",
    help: "write `0x{object:04X}` for its value",
    also: &[ADDED],
    ..Rule::NEW
};

/// A sub-object that is added.
const ADDED: Form = Form {
    help: "remove the object, and add it with `code = record`",
    ..Form::OWN
};

/// The finding about a sub-index of an object with this code.
pub(crate) fn finding(target: &Spanned<Target>, code: ObjectCode) -> Finding {
    target
        .finding(&RULE, target.span)
        .fact("object", Fact::Index(target.index))
        .fact("code", code)
}

/// The same, about an `add`.
pub(crate) fn added(target: &Spanned<Target>, code: ObjectCode) -> Finding {
    finding(target, code).form(&ADDED)
}
