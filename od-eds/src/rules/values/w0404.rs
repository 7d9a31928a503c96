use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0404",
    severity: Warning,
    title: "AccessType is missing",
    why: "Every value says who may write it. `ro` is taken.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "there is no {AccessType}",
    help: "write `{AccessType=ro}`, which is taken now, or what it is",
    ..Rule::NEW
};

/// The finding about a section without AccessType.
pub(crate) fn finding(header: Span) -> Finding {
    RULE.at(header)
        .fix(Fix::unsafe_fix().below(header, "AccessType=ro"))
}
