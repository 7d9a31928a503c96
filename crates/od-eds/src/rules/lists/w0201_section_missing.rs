use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0201",
    severity: Error,
    buildable: true,
    title: "listed object has no section",
    why: "A master that trusts the lists fails at the missing section. odkit ignores the entry.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Unsafe,
    says: "{object} is listed, but section [{object:04X}] is missing",
    help: "remove the entry{fix}, or add the section",
    ..Rule::NEW
};

/// The finding about an entry of a list whose object has no section.
pub(crate) fn finding(entry: Span, index: u16) -> Finding {
    RULE.at(entry)
        .index(index)
        .fix(Fix::unsafe_fix().remove_line(entry))
}
