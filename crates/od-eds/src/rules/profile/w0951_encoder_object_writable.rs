use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Warning};
use crate::rules::profile::shared::access;
use crate::subject::Object;

pub(crate) static W0951: Rule = Rule {
    code: "W0951",
    severity: Warning,
    title: "encoder object is writable",
    why: "A master can change a value that only the device sets.",
    source: "CiA 406, object overview",
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} is `{given}`, but CiA {profile} specifies `{right}`",
    help: "write `{AccessType={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    access(&W0951, &[406], false, object, findings);
}
