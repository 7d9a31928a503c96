//! I0531: COB-ID does not follow the node ID.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0531",
    severity: Info,
    title: "COB-ID does not follow the node ID",
    why: "Two such devices in one network send on one identifier. The first four PDOs usually have $NODEID in their COB-IDs.",
    source: "CiA 301, predefined connection set",
    ..Rule::NEW
};
