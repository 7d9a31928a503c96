//! W0206: object is in the wrong list.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0206",
    severity: Warning,
    title: "object is in the wrong list",
    why: "2000h–5FFFh belong to [ManufacturerObjects], the mandatory three to [MandatoryObjects], all others to [OptionalObjects].",
    source: "CiA 306-1, object lists",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=2\n\
        1=0x1017\n\
        2=0x2000\n\
        \n\
        [ManufacturerObjects]\n\
        SupportedObjects=0",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=1\n\
        1=0x1017\n\
        \n\
        [ManufacturerObjects]\n\
        SupportedObjects=1\n\
        1=0x2000",
    ..Rule::NEW
};
