use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::rules::structure::shared::Count;
use crate::subject::Object;

pub(crate) static W0350: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "sub-index 0 is higher than the highest sub-index",
    why: "A master that reads up to sub-index 0 gets an abort for each sub-object that does not exist.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    says: "sub-index 0 is {given}, but the highest sub-index is {highest}",
    help: "write `{DefaultValue={highest}}`{fix}",
    check: Check::Object(check),
    ..Rule::of("W0350")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let count = Count::of(object).filter(|count| count.is_too_high() && !count.is_error());
    findings.extend(count.map(|count| count.finding(&W0350)));
}
