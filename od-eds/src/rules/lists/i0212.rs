use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Info};
use crate::fix::Fix;
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "I0212",
    severity: Info,
    title: "section name is not written as `1018` or `1018sub2`",
    why: "Four hexadecimal digits, and behind `sub` as many as it takes. Other ways are read the same; many readers do not see the object.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "[{name}] is read as [{right}]",
    help: "write `[{right}]`",
    ..Rule::NEW
};

/// The finding about the section of an object whose name is written in another way.
pub(crate) fn finding(section: &Placed<'_>, right: &str) -> Finding {
    RULE.at(section.header)
        .fact("name", &*section.name.value)
        .fact("right", right)
        .fix(Fix::safe().replace(section.header, format!("[{right}]")))
}
