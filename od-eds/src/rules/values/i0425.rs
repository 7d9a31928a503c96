//! I0425: type that the file defines.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0425",
    severity: Info,
    title: "type that the file defines",
    why: "The object of that index says in sub-index 1 which basic type it stands for. That type is taken, with its limits; most readers know no such types.",
    source: "CanFestival, object dictionary editor",
    ..Rule::NEW
};
