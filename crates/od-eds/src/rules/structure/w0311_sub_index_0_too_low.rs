use alloc::format;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Form, Rule, Severity::Error};
use crate::rules::structure::shared::{Count, counts_in_use, decimal};
use crate::subject::Object;

pub(crate) static W0311: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "sub-index 0 is lower than the highest sub-index",
    why: "A master that reads up to sub-index 0 never sees the sub-objects above it.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    says: "sub-index 0 is {given}, but sub-index {highest} exists",
    help: "write `{DefaultValue={highest}}`{fix}",
    also: &[DECIMAL],
    check: Check::Object(check),
    ..Rule::of("W0311")
};

/// The help if a section is probably named in decimal: sub-index 0 is right then.
const DECIMAL: Form = Form {
    help: "write `{right}` if the sub-index is decimal; CiA 306 numbers sub-objects in hexadecimal",
    ..Form::OWN
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let Some(count) = Count::of(object) else {
        return;
    };
    let in_use = count.entry.access.writable() || counts_in_use(object.index);
    if count.given.value < u64::from(count.highest) && !in_use {
        let finding = count.finding(&W0311);
        findings.push(match decimal(object.object) {
            Some((_, meant)) => {
                let right = format!("[{:04X}sub{meant:X}]", object.index);
                finding.form(&DECIMAL).fact("right", right)
            }
            None => finding,
        });
    }
}
