use crate::finding::{Finding, Rule, Severity::Error};

pub(crate) static RULE: Rule = Rule {
    code: "W0203",
    severity: Error,
    buildable: true,
    title: "object lists are missing or empty",
    why: "A tool that follows the lists finds no objects. odkit reads the section of every object.",
    source: "CiA 306-1, object lists",
    says: "the object lists are missing or empty",
    help: "list the objects in [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]",
    ..Rule::NEW
};

/// The finding about a file whose lists are missing or empty.
pub(crate) fn finding() -> Finding {
    RULE.finding()
}
