//! I0610: date or time is not written as CiA 306 writes it.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0610",
    severity: Info,
    title: "date or time is not written as CiA 306 writes it",
    why: "`MM-DD-YYYY` and `hh:mmAM`. It is kept as it is; some editors drop it.",
    source: "CiA 306-1, FileInfo",
    ..Rule::NEW
};
