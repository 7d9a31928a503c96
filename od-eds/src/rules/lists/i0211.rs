use crate::finding::{Finding, Rule, Severity::Info};
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "I0211",
    severity: Info,
    title: "section is none of CiA 306",
    why: "It is kept, and nothing reads it. Tools put their own notes into sections; a slip in the name of an object hides the object.",
    source: "CiA 306-1, file format",
    says: "[{name}] is no section of CiA 306",
    help: "it is kept; if an object is meant, write `[2000]` or `[2000sub1]`",
    ..Rule::NEW
};

/// The finding about a section that CiA 306 does not define.
pub(crate) fn finding(section: &Placed<'_>) -> Finding {
    RULE.at(section.header).fact("name", &*section.name.value)
}
