//! W0521: two PDOs have one COB-ID.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0521",
    severity: Warning,
    title: "two PDOs have one COB-ID",
    why: "Two PDOs of one device on one identifier cannot be told apart.",
    source: "CiA 301, PDO communication parameter",
    before: "\
        [1801sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=$NODEID+0x180\n\
        PDOMapping=0",
    after: "\
        [1801sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=$NODEID+0x280\n\
        PDOMapping=0",
    ..Rule::NEW
};
