use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "W0209",
    severity: Warning,
    title: "compact section without CompactSubObj",
    why: "A tool ignores the names and values in the section. [xxxxName], [xxxxValue] and [xxxxDenotation] belong to an object with CompactSubObj. odkit keeps the section and ignores it.",
    source: "CiA 306-1, CompactSubObj",
    says: "[{name}] needs an object with {CompactSubObj}",
    help: "write `{CompactSubObj=}` and the number of sub-objects in [{object:04X}], or remove the section",
    ..Rule::NEW
};

/// The finding about a compact section of an object that has no CompactSubObj.
pub(crate) fn finding(section: &Placed<'_>, index: u16) -> Finding {
    RULE.at(section.header)
        .index(index)
        .fact("name", &*section.name.value)
}
