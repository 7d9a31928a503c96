use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static E0505: Rule = Rule {
    title: "PDO is longer than 64 bits",
    why: "A CAN frame has at most eight data bytes.",
    source: "CiA 301, PDO mapping parameter",
    says: "this entry brings the PDO to {bits} bits; the limit is 64",
    help: "remove a mapping entry, or map a shorter object",
    check: Check::Object(check),
    ..Rule::of("E0505")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let mut bits = 0u32;
    for mapped in mapped(object) {
        let before = bits;
        bits += u32::from(mapped.bits);
        if before <= 64 && bits > 64 {
            findings.push(mapped.finding(&E0505).fact("bits", bits));
        }
    }
}
