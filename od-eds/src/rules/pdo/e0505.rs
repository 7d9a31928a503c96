use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static RULE: Rule = Rule {
    code: "E0505",
    severity: Error,
    title: "PDO is longer than 64 bits",
    why: "A CAN frame carries eight bytes.",
    source: "CiA 301, PDO mapping parameter",
    says: "with this object the PDO has {bits} bits",
    help: "a PDO has at most 64 bits; map less",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let mut bits = 0u32;
    for mapped in mapped(object) {
        let before = bits;
        bits += u32::from(mapped.bits);
        if before <= 64 && bits > 64 {
            findings.push(mapped.finding(&RULE).fact("bits", bits));
        }
    }
}
