use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::values::e0414_parameter_value_outside_limits::fails;
use crate::rules::values::shared::{ABOVE, BELOW, WITHIN, outside};
use crate::subject::Entry;

pub(crate) static W0452: Rule = Rule {
    code: "W0452",
    severity: Warning,
    title: "default value is outside its limits",
    why: "A device that checks its limits does not accept its own default value. odkit uses the default value as it is.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: BELOW,
    help: WITHIN,
    also: &[ABOVE],
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let odd = outside(entry).filter(|outside| !fails(outside));
    findings.extend(odd.map(|outside| outside.finding(&W0452, entry)));
}
