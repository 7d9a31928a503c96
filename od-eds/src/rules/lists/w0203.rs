//! W0203: file has no object lists.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0203",
    severity: Warning,
    title: "file has no object lists",
    why: "A reader that follows the lists sees no objects. Every section is taken for an object.",
    source: "CiA 306-1, object lists",
    before: "\
        [DummyUsage]\n\
        Dummy0007=0",
    after: "\
        [DummyUsage]\n\
        Dummy0007=0\n\
        \n\
        [MandatoryObjects]\n\
        SupportedObjects=3\n\
        1=0x1000\n\
        2=0x1001\n\
        3=0x1018\n\
        \n\
        [OptionalObjects]\n\
        SupportedObjects=1\n\
        1=0x1017\n\
        \n\
        [ManufacturerObjects]\n\
        SupportedObjects=0",
    ..Rule::NEW
};
