use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0302",
    severity: Warning,
    title: "object with members has no ObjectType",
    why: "Without ObjectType an object is a VAR, and this one has members. It is taken for a RECORD.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "there is no {ObjectType}, but there are members",
    help: "write `{ObjectType=0x9}` (RECORD) or `{ObjectType=0x8}` (ARRAY)",
    ..Rule::NEW
};

/// The finding about an object without ObjectType whose members have sections.
pub(crate) fn finding(header: Span) -> Finding {
    RULE.at(header)
        .fix(Fix::unsafe_fix().below(header, "ObjectType=0x9"))
}
