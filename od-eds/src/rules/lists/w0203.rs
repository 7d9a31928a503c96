use crate::finding::{Finding, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0203",
    severity: Warning,
    title: "file has no object lists",
    why: "A reader that follows the lists sees no objects. Every section is taken for an object.",
    source: "CiA 306-1, object lists",
    says: "no object is listed",
    help: "list the objects in [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]",
    ..Rule::NEW
};

/// The finding about a file whose lists are missing or empty.
pub(crate) fn finding() -> Finding {
    RULE.finding()
}
