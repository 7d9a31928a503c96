use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::rules::profile::shared::access;
use crate::subject::Object;

pub(crate) static E0907: Rule = Rule {
    code: "E0907",
    severity: Error,
    buildable: true,
    title: "access to a profile object is missing",
    why: "A master that reads or writes the object as the profile specifies gets an abort.",
    source: "CiA 401, CiA 402 and CiA 404, object overview",
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} is `{given}`, but CiA {profile} specifies `{right}`",
    help: "write `{AccessType={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    access(&E0907, &[401, 402, 404], true, object, findings);
}
