use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::names::List;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0202",
    severity: Warning,
    title: "object is missing from the lists",
    why: "A tool that follows the lists does not find the object. odkit keeps it.",
    source: "CiA 306-1, object lists",
    says: "{object} is missing from the object lists",
    help: "add `0x{object:04X}` to [{list}]",
    ..Rule::NEW
};

/// The finding about an object that no list has.
pub(crate) fn finding(object: Span, index: u16) -> Finding {
    RULE.at(object)
        .index(index)
        .fact("list", List::of(index).name())
}
