use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Info};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0425",
    severity: Info,
    title: "data type defined in the file",
    why: "Sub-index 1 of the object with that index gives the basic type. odkit uses this type and its limits; most EDS parsers do not know such types.",
    source: "CanFestival, object dictionary editor",
    says: "`{given}` is a data type that the file defines",
    help: "write `{DataType={right}}`",
    ..Rule::NEW
};

/// The finding about a type of the file, with the place of its basic type.
pub(crate) fn finding(given: &Text<'_>, stands_for: &Text<'_>) -> Finding {
    let finding = RULE
        .given(given)
        .key(Key::DataType)
        .fact("right", &*stands_for.value);
    finding.related(stands_for.span, "basic type defined here")
}
