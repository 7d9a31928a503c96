use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::rules::profile::shared::access;
use crate::subject::Object;

pub(crate) static E0961: Rule = Rule {
    code: "E0961",
    severity: Error,
    buildable: true,
    title: "access to an encoder object is missing",
    why: "A master that reads or writes the object as the profile specifies gets an abort.",
    source: "CiA 406, object overview",
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} is `{given}`, but CiA {profile} specifies `{right}`",
    help: "write `{AccessType={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    access(&E0961, &[406], true, object, findings);
}
