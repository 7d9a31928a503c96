use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Warning};
use crate::rules::profile::shared::access;
use crate::subject::Object;

pub(crate) static W0906: Rule = Rule {
    code: "W0906",
    severity: Warning,
    title: "profile object is writable",
    why: "A master can change a value that only the device sets.",
    source: "CiA 401, CiA 402 and CiA 404, object overview",
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} is `{given}`, but CiA {profile} specifies `{right}`",
    help: "write `{AccessType={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    access(&W0906, &[401, 402, 404], false, object, findings);
}
