use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::Entry;
use od_model::Address;

pub(crate) static W0639: Rule = Rule {
    title: "error history of a new device is not empty",
    why: "A master reads errors that never occurred. Sub-index 0 of 1003h counts the errors in the history, not its size.",
    source: "CiA 301, object 1003h",
    fixability: Fixability::Unsafe,
    says: "{DefaultValue} is {given}, but the error history of a new device is empty",
    help: "write `{DefaultValue=0}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0639")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if entry.address == Address::new(0x1003, 0)
        && let Some(value) = &entry.default
        && value.integer(0).is_some_and(|number| number != 0)
    {
        let fix = Fix::unsafe_fix().replace(value.span, "0");
        let finding = W0639
            .on(entry, value.span)
            .fact("given", value.value.clone());
        findings.push(finding.fix(fix));
    }
}
