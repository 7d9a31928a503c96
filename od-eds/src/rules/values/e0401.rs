use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::subject::{Entry, is_definition};

pub(crate) static RULE: Rule = Rule {
    code: "E0401",
    severity: Error,
    title: "DataType is missing",
    why: "Nothing is known of a value without a type. It is left out of the dictionary.",
    source: "CiA 306-1, object sections",
    says: "there is no {DataType}",
    help: "write `{DataType=}` and the code of a type, for example `0x0007` for UNSIGNED32",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    // An unknown DataType was found by the reader.
    let missing = entry.data_type.is_none() && !entry.is_unread(Key::DataType);
    if missing && !is_definition(entry.object) {
        findings.push(RULE.on(entry, entry.span));
    }
}
