//! I0345: two members have one name.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0345",
    severity: Info,
    title: "two members have one name",
    why: "Masters that find values by their names find only one of them.",
    source: "odkit; python-canopen and others look up by name",
    before: "\
        [2000sub1]\n\
        ParameterName=Cut-off\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    after: "\
        [2000sub1]\n\
        ParameterName=Order\n\
        ObjectType=0x7\n\
        DataType=0x0005",
    ..Rule::NEW
};
