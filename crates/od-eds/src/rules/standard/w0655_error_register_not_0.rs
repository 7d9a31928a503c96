use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::Entry;
use od_model::Address;

pub(crate) static W0655: Rule = Rule {
    title: "error register of a new device is not 0",
    why: "A master reads an error that never occurred.",
    source: "CiA 301, object 1001h",
    fixability: Fixability::Unsafe,
    says: "{DefaultValue} is {given}, but a new device has no error",
    help: "write `{DefaultValue=0}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0655")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if entry.address == Address::new(0x1001, 0)
        && let Some(value) = &entry.default
        && value.integer(0).is_some_and(|number| number != 0)
    {
        let finding = W0655
            .on(entry, value.span)
            .fact("given", value.value.clone());
        findings.push(finding.fix(Fix::unsafe_fix().replace(value.span, "0")));
    }
}
