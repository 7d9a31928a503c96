//! I0411: $NODEID is not written as `$NODEID+n`.

use crate::finding::Severity::Info;
use crate::finding::{Fixability, Rule};

pub(crate) static RULE: Rule = Rule {
    code: "I0411",
    severity: Info,
    title: "$NODEID is not written as `$NODEID+n`",
    why: "Another order, other case or blanks are read the same; not every reader does.",
    source: "CiA 306-1, $NODEID",
    fixability: Fixability::Safe,
    ..Rule::NEW
};
