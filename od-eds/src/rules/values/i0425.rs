use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Info};
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0425",
    severity: Info,
    title: "type that the file defines",
    why: "The object of that index says in sub-index 1 which basic type it stands for. That type is taken, with its limits; most readers know no such types.",
    source: "CanFestival, object dictionary editor",
    says: "`{given}` is a type that the file defines",
    help: "write `{DataType={right}}`",
    ..Rule::NEW
};

/// The finding about a type that stands for one of CiA 301.
pub(crate) fn finding(given: &Text<'_>, stands_for: &Text<'_>) -> Finding {
    let finding = RULE
        .given(given)
        .key(Key::DataType)
        .fact("right", &*stands_for.value);
    finding.related(stands_for.span, "it stands for this type")
}
