use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Warning};
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static RULE: Rule = Rule {
    code: "W0513",
    severity: Warning,
    title: "PDO maps a BOOLEAN with 8 bits",
    why: "A BOOLEAN has one bit in a PDO. Some stacks send a byte, and a master that goes by the type reads the rest of the PDO wrong.",
    source: "CiA 301, data types and PDO mapping parameter",
    fixability: Fixability::Unsafe,
    says: "{object} has {right:bit|bits}, but is mapped with {bits}",
    help: "write `{entry}`",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        if let Some(wrong) = mapped.wrong_length()
            && wrong.is_boolean(&mapped)
        {
            findings.push(wrong.finding(&RULE, &mapped));
        }
    }
}
