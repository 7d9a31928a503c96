//! E0503: PDO maps an object of the wrong direction.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0503",
    severity: Error,
    title: "PDO maps an object of the wrong direction",
    why: "A TPDO carries what can be read (ro, rw, rwr, const), an RPDO what can be written (wo, rw, rww).",
    source: "CiA 306-1, AccessType",
    ..Rule::NEW
};
