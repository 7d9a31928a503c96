use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::rules::profile::shared::types;
use crate::subject::Object;

pub(crate) static W0950: Rule = Rule {
    code: "W0950",
    severity: Error,
    buildable: true,
    title: "encoder object has another object code or type",
    why: "A master that knows the object from CiA 406 reads and writes it with another length.",
    source: "CiA 406, object overview",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA {profile} specifies {right}",
    help: "write `{key={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    types(&W0950, &[406], object, findings);
}
