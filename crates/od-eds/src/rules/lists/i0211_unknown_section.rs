use crate::finding::{Finding, Rule, Severity::Info};
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "I0211",
    severity: Info,
    title: "section is not defined in CiA 306",
    why: "A typo in the name of an object hides the object. odkit keeps the section and ignores it; some tools store notes in sections of their own.",
    source: "CiA 306-1, file format",
    says: "[{name}] is not a section of CiA 306",
    help: "write `[2000]` or `[2000sub1]` if an object is meant",
    ..Rule::NEW
};

/// The finding about a section that CiA 306 does not define.
pub(crate) fn finding(section: &Placed<'_>) -> Finding {
    RULE.at(section.header).fact("name", &*section.name.value)
}
