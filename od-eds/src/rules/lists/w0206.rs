//! W0206: object is in the wrong list.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0206",
    severity: Warning,
    title: "object is in the wrong list",
    why: "2000h–5FFFh belong to [ManufacturerObjects], the mandatory three to [MandatoryObjects], all others to [OptionalObjects].",
    source: "CiA 306-1, object lists",
    ..Rule::NEW
};
