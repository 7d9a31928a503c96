use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::values::shared::{ABOVE, BELOW, Outside, WITHIN, outside};
use crate::subject::Entry;

pub(crate) static E0414: Rule = Rule {
    code: "E0414",
    severity: Error,
    title: "configured value is outside its limits",
    why: "A device aborts the download of a value outside its limits, so a master cannot configure it.",
    source: "CiA 306-1, LowLimit and HighLimit",
    says: BELOW,
    help: WITHIN,
    also: &[ABOVE],
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let fails = outside(entry).filter(fails);
    findings.extend(fails.map(|outside| outside.finding(&E0414, entry)));
}

/// A master that configures by a DCF gets an abort; a default is only unusual.
pub(super) fn fails(outside: &Outside<'_>) -> bool {
    outside.key == Key::ParameterValue
}
