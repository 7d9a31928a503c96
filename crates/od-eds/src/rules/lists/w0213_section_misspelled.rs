use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "W0213",
    severity: Warning,
    title: "section name is probably misspelled",
    why: "A tool ignores the section. odkit keeps it and ignores it.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Unsafe,
    says: "[{name}] is not a section of CiA 306",
    help: "write `[{meant}]` if this section is meant{fix}",
    ..Rule::NEW
};

/// The finding about a section whose name is probably misspelled.
pub(crate) fn finding(section: &Placed<'_>, meant: &str) -> Finding {
    RULE.at(section.header)
        .fact("name", &*section.name.value)
        .fact("meant", meant)
        .fix(Fix::unsafe_fix().replace(section.header, format!("[{meant}]")))
}
