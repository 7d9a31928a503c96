use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::values::e0414::fails;
use crate::rules::values::shared::{ABOVE, outside};
use crate::subject::Entry;

pub(crate) static RULE: Rule = Rule {
    code: "W0452",
    severity: Warning,
    title: "default is outside its limits",
    why: "A device refuses to be set to what its own default is. The default is taken as it is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: "{key} {value} is below {LowLimit} {limit}",
    help: "write a {key} within the limits, or mend the limit",
    also: &[ABOVE],
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let odd = outside(entry).filter(|outside| !fails(outside));
    findings.extend(odd.map(|outside| outside.finding(&RULE, entry)));
}
