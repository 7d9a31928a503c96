use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::standards::cia301::of;
use crate::subject::Entry;
use od_model::{Access, Address};

pub(crate) static W0632: Rule = Rule {
    title: "standard object has another access",
    why: "A master can change a value that only the device sets, or cannot reset a value that it resets.",
    source: "CiA 301, chapter 7.5; CiA 302",
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} ({name}) is `{given}`, but {standard} specifies `{right}`",
    help: "write `{AccessType={fixed}}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0632")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Address { index, sub } = entry.address;
    let Some(standard) = of(index).filter(|found| found.is_like(*entry.object.code)) else {
        return;
    };
    let own = *entry.access;
    let fixed = match standard.value(sub).map(|value| value.access) {
        // The device itself sets these values. Another rule is about values that cannot be read.
        Some(Access::Ro | Access::Const) if own.writable() && own != Access::Wo => Access::Ro,
        // A master clears the error history by writing 0.
        None if (index, sub) == (0x1003, 0) && !own.writable() => Access::Rw,
        _ => return,
    };
    let right = standard.value(sub).map_or(fixed, |value| value.access);
    let finding = W0632
        .on(entry, entry.access.span)
        .fact("object", entry.shown());
    let finding = finding.fact("name", standard.name).fact("right", right);
    let finding = finding
        .fact("standard", standard.source())
        .fact("given", own);
    let fix = Fix::unsafe_fix().replace(entry.access.span, fixed.name());
    findings.push(finding.fact("fixed", fixed).fix(fix));
}
