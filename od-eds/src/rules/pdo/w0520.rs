//! W0520: COB-ID is kept for another service.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0520",
    severity: Warning,
    title: "COB-ID is kept for another service",
    why: "A PDO, SYNC, TIME or EMCY on an identifier of NMT, SDO, error control or LSS disturbs that service in every device of the network.",
    source: "CiA 301, restricted CAN-IDs",
    before: "\
        [1800sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=0x601\n\
        PDOMapping=0",
    after: "\
        [1800sub1]\n\
        DataType=0x0007\n\
        AccessType=rw\n\
        DefaultValue=$NODEID+0x180\n\
        PDOMapping=0",
    ..Rule::NEW
};
