use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "W0213",
    severity: Warning,
    title: "section name is nearly one of CiA 306",
    why: "It looks like a slip. The section is kept, and nothing reads it.",
    source: "CiA 306-1, file format",
    fixability: Fixability::Unsafe,
    says: "there is no section [{name}] in CiA 306",
    help: "write `[{meant}]`, if that is meant",
    ..Rule::NEW
};

/// The finding about a section that is likely a slip for another.
pub(crate) fn finding(section: &Placed<'_>, meant: &str) -> Finding {
    RULE.at(section.header)
        .fact("name", &*section.name.value)
        .fact("meant", meant)
        .fix(Fix::unsafe_fix().replace(section.header, format!("[{meant}]")))
}
