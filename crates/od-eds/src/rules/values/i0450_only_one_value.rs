use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Info};
use crate::subject::Entry;

pub(crate) static I0450: Rule = Rule {
    code: "I0450",
    severity: Info,
    title: "limits allow only one value",
    why: "A master can write the object, but only to the value that it has. Editors often leave such limits.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: "{LowLimit} equals {HighLimit}, so this `{access}` object can have only one value",
    help: "write the limits of the device, or remove both",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let (Some(low), Some(high)) = (&entry.low, &entry.high)
        && low.value == high.value
        && entry.access.writable()
    {
        let finding = I0450.on(entry, high.span).fact("access", *entry.access);
        findings.push(finding.related(low.span, "{LowLimit} set here"));
    }
}
