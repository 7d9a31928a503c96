use alloc::format;

use crate::finding::{Finding, Fixability, Rule, Severity};
use crate::fix::Fix;
use crate::scan::placed::Placed;

pub(crate) static RULE: Rule = Rule {
    code: "I0212",
    severity: Severity::Warning,
    buildable: true,
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
    // With another index the whole object is lost, with a leading 0 in the sub-index a sub-object.
    let own = |name: &str| name.get(..4).map(str::to_ascii_uppercase);
    let severity = if own(&section.name.value) == own(right) {
        Severity::Warning
    } else {
        Severity::Error
    };
    RULE.at(section.header)
        .severity_of(severity)
        .fact("name", &*section.name.value)
        .fact("right", right)
        .fix(Fix::safe().replace(section.header, format!("[{right}]")))
}
