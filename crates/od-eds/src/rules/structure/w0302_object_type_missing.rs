use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0302",
    severity: Warning,
    title: "object with sub-objects has no ObjectType",
    why: "A tool assumes a VAR and misses the sub-objects. odkit assumes a RECORD.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{ObjectType} is missing, but sub-objects exist",
    help: "write `{ObjectType=0x9}` for a RECORD{fix}, or `{ObjectType=0x8}` for an ARRAY",
    ..Rule::NEW
};

/// The finding about an object without ObjectType that has sub-objects.
pub(crate) fn finding(header: Span) -> Finding {
    RULE.at(header)
        .fix(Fix::unsafe_fix().below(header, "ObjectType=0x9"))
}
