use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::rules::pdo::shared::{WRITE_ENTRY, WRONG_LENGTH, mapped};
use crate::subject::Object;

pub(crate) static E0504: Rule = Rule {
    title: "PDO maps an object with a wrong length",
    why: "The low byte of a mapping entry is the length of the object in bits. A device aborts the download of another length.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    says: WRONG_LENGTH,
    help: WRITE_ENTRY,
    check: Check::Object(check),
    ..Rule::of("E0504")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        if let Some(wrong) = mapped.wrong_length()
            && !wrong.is_boolean(&mapped)
        {
            findings.push(wrong.finding(&E0504, &mapped));
        }
    }
}
