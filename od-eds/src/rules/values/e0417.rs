//! E0417: $NODEID where it cannot be.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0417",
    severity: Error,
    title: "$NODEID where it cannot be",
    why: "Only an UNSIGNED8, UNSIGNED16, UNSIGNED24 or UNSIGNED32 can depend on the node ID.",
    source: "CiA 306-1, $NODEID",
    before: "\
        [2000]\n\
        DataType=0x0008\n\
        AccessType=rw\n\
        DefaultValue=$NODEID+0x80\n\
        PDOMapping=0",
    after: "\
        [2000]\n\
        DataType=0x0008\n\
        AccessType=rw\n\
        DefaultValue=1.5\n\
        PDOMapping=0",
    ..Rule::NEW
};
