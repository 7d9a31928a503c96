use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::pdo::shared::numbers;
use crate::subject::Object;

pub(crate) static W0525: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "mapping entry in use is 0",
    why: "Sub-index 0 is the number of mapped objects, and each of these entries names one. A device aborts such a mapping.",
    source: "CiA 301, PDO mapping parameter",
    says: "mapping entry is 0, but sub-index 0 counts it as mapped",
    help: "write the mapped object, such as `0x60040020`, or lower sub-index 0",
    check: Check::Object(check),
    ..Rule::of("W0525")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for (entry, number) in numbers(object) {
        // The entry is 0, even its length, so no other part needs a check.
        if number.value == 0 {
            findings.push(W0525.on(&entry, number.span));
        }
    }
}
