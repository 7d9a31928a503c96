//! E0418: $NODEID formula does not fit its type for every node ID.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0418",
    severity: Error,
    title: "$NODEID formula does not fit its type for every node ID",
    why: "The sum with the highest node ID, 127, must fit.",
    source: "CiA 306-1, $NODEID",
    ..Rule::NEW
};
