use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::rules::profile::shared::types;
use crate::subject::Object;

pub(crate) static W0905: Rule = Rule {
    code: "W0905",
    severity: Error,
    buildable: true,
    title: "profile object has another object code or type",
    why: "A master that knows the object from the device profile reads and writes it with another length.",
    source: "CiA 401, CiA 402 and CiA 404, object overview",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA {profile} specifies {right}",
    help: "write `{key={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    types(&W0905, &[401, 402, 404], object, findings);
}
