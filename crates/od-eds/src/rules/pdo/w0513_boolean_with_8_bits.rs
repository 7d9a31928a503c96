use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::rules::pdo::shared::{WRITE_ENTRY, WRONG_LENGTH, mapped};
use crate::subject::Object;

pub(crate) static W0513: Rule = Rule {
    title: "PDO maps a BOOLEAN with 8 bits",
    why: "A BOOLEAN has one bit in a PDO. Some stacks send a byte; a master that uses the type decodes the rest of the PDO wrongly.",
    source: "CiA 301, data types and PDO mapping parameter",
    fixability: Fixability::Unsafe,
    says: WRONG_LENGTH,
    help: WRITE_ENTRY,
    check: Check::Object(check),
    ..Rule::of("W0513")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        if let Some(wrong) = mapped.wrong_length()
            && wrong.is_boolean(&mapped)
        {
            findings.push(wrong.finding(&W0513, &mapped));
        }
    }
}
