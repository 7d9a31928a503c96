use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::pdo::shared::{count, numbers};
use crate::subject::Object;

pub(crate) static RULE: Rule = Rule {
    code: "W0525",
    severity: Warning,
    title: "mapping entry in use maps nothing",
    why: "Sub-index 0 says how many objects are mapped, and each of these entries names one.",
    source: "CiA 301, PDO mapping parameter",
    says: "{count} objects are mapped, but this entry maps nothing",
    help: "write what is mapped, or a lower number into sub-index 0",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for (entry, number) in numbers(object) {
        // Nothing, not even a length: there is nothing else to judge.
        if number.value == 0 {
            let count = count(object).unwrap_or(0);
            findings.push(RULE.on(&entry, number.span).fact("count", count));
        }
    }
}
