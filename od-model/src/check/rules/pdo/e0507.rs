//! E0507: TPDO maps a dummy.

use crate::Severity::Error;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "E0507",
    severity: Error,
    title: "TPDO maps a dummy",
    why: "Dummies fill gaps in what is received; there is nothing to send.",
    source: "CiA 301, dummy mapping",
    mending: Mending::None,
    before: "",
    after: "",
};
