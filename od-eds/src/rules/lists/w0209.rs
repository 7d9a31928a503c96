use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "W0209",
    severity: Warning,
    title: "compact section without CompactSubObj",
    why: "[xxxxName], [xxxxValue] and [xxxxDenotation] belong to an object with CompactSubObj. The section is kept, and nothing reads it.",
    source: "CiA 306-1, CompactSubObj",
    says: "[{name}] belongs to an object with {CompactSubObj}",
    help: "write `{CompactSubObj=}` and the number of members in [{object:04X}], or remove the section",
    ..Rule::NEW
};

/// The finding about a compact section of an object that has no CompactSubObj.
pub(crate) fn finding(section: &Placed<'_>, index: u16) -> Finding {
    RULE.at(section.header)
        .index(index)
        .fact("name", &*section.name.value)
}
