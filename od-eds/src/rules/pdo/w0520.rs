//! W0520: COB-ID is kept for another service.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0520",
    severity: Warning,
    title: "COB-ID is kept for another service",
    why: "A PDO, SYNC, TIME or EMCY on an identifier of NMT, SDO, error control or LSS disturbs that service in every device of the network.",
    source: "CiA 301, restricted CAN-IDs",
    ..Rule::NEW
};
