use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Info};
use crate::subject::Entry;

pub(crate) static RULE: Rule = Rule {
    code: "I0450",
    severity: Info,
    title: "limits leave one value",
    why: "A value that can be written, but only to what it is: such limits are usually left over from an editor.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: "between the limits there is one value for a {access} object",
    help: "write the limits that the device has, or leave both empty",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let (Some(low), Some(high)) = (&entry.low, &entry.high)
        && low.value == high.value
        && entry.access.writable()
    {
        let finding = RULE.on(entry, high.span).fact("access", *entry.access);
        findings.push(finding.related(low.span, "{LowLimit} is here"));
    }
}
