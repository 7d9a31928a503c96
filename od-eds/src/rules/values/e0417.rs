//! E0417: $NODEID where it cannot be.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0417",
    severity: Error,
    title: "$NODEID where it cannot be",
    why: "Only an UNSIGNED8, UNSIGNED16, UNSIGNED24 or UNSIGNED32 can depend on the node ID.",
    source: "CiA 306-1, $NODEID",
    ..Rule::NEW
};
