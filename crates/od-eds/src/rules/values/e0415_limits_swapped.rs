use alloc::vec::Vec;

use crate::fact::{Key, shown};
use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::rules::values::shared::{crossed, limits};
use crate::subject::Entry;

pub(crate) static E0415: Rule = Rule {
    code: "E0415",
    severity: Error,
    title: "LowLimit is greater than HighLimit",
    why: "No value lies between the two, so a master cannot write the object.",
    source: "CiA 306-1, LowLimit and HighLimit",
    fixability: Fixability::Unsafe,
    says: "{LowLimit} `{low}` is greater than {HighLimit} `{high}`",
    help: "swap the two limits{fix}, or remove both",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let (low, high) = limits(entry);
    if let (Some(low), Some(high), true) = (low, high, crossed(low, high)) {
        let swap = Fix::unsafe_fix()
            .replace(low.span, shown(high))
            .replace(high.span, shown(low));
        let finding = E0415.on(entry, low.span).key(Key::LowLimit);
        let finding = finding
            .fact("low", low.value.clone())
            .fact("high", high.value.clone());
        findings.push(finding.related(high.span, "{HighLimit} set here").fix(swap));
    }
}
