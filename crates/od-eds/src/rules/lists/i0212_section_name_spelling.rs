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
    fixability: Fixability::Either,
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
    // Fewer digits may be another index than the one that they make with zeros.
    let plain = section.name.value.to_ascii_lowercase();
    let index = plain.split("sub").next().unwrap_or_default();
    let index = index.strip_prefix("0x").unwrap_or(index);
    let digits = index.bytes().filter(u8::is_ascii_hexdigit).count();
    // A tool that ignores the section now would stop at an object without a type or an access.
    let has = |key: &str| section.get(key).is_some_and(|value| !value.is_empty());
    let is_whole = has("DataType") && has("AccessType") || has("SubNumber") || has("CompactSubObj");
    let fix = if digits < 4 || !is_whole {
        Fix::unsafe_fix()
    } else {
        Fix::safe()
    };
    RULE.at(section.header)
        .severity_of(severity)
        .fact("name", &*section.name.value)
        .fact("right", right)
        .fix(fix.replace(section.header, format!("[{right}]")))
}
