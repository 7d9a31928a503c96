use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::rules::pdo::shared::counted;
use crate::subject::Object;
use od_model::DataType;

pub(crate) static RULE: Rule = Rule {
    code: "E0510",
    severity: Error,
    title: "mapping entry is no UNSIGNED32",
    why: "A mapping entry is index, sub-index and length in one UNSIGNED32.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    says: "a mapping entry must be UNSIGNED32, but is {given}",
    help: "write `{DataType=0x0007}`",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for entry in counted(object) {
        if let Some(given) = entry
            .data_type
            .filter(|given| **given != DataType::Unsigned32)
        {
            let fix = Fix::unsafe_fix().replace(given.span, "0x0007");
            findings.push(RULE.on(&entry, given.span).fact("given", *given).fix(fix));
        }
    }
}
