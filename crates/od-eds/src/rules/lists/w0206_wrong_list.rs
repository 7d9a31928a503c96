use crate::finding::{Finding, Rule, Severity::Warning};
use crate::scan::names::List;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0206",
    severity: Warning,
    title: "object is in the wrong list",
    why: "A tool that reads only one list misses the object. 2000h to 5FFFh belong to [ManufacturerObjects], 1000h, 1001h and 1018h to [MandatoryObjects], all others to [OptionalObjects].",
    source: "CiA 306-1, object lists",
    says: "{object} belongs to [{right}], not to [{wrong}]",
    help: "move the entry to [{right}]",
    ..Rule::NEW
};

/// The finding about an entry in a list that is not for its object.
pub(crate) fn finding(entry: Span, index: u16, list: List) -> Finding {
    RULE.at(entry)
        .index(index)
        .fact("right", List::of(index).name())
        .fact("wrong", list.name())
}
