use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "I0212",
    severity: Warning,
    title: "section name is not written as `1018` or `1018sub2`",
    why: "Many tools do not find the object. odkit reads it. An index has four hexadecimal digits, a sub-index no leading 0.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "odkit reads [{name}] as [{right}]",
    help: "write `[{right}]`{fix}",
    ..Rule::NEW
};

/// The finding about the section of an object whose name is written in another way.
pub(crate) fn finding(section: &Placed<'_>, right: &str) -> Finding {
    RULE.at(section.header)
        .fact("name", &*section.name.value)
        .fact("right", right)
        .fix(Fix::safe().replace(section.header, format!("[{right}]")))
}
