use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::rules::standard::table::of;
use crate::subject::Entry;
use od_model::{Access, Address};

pub(crate) static RULE: Rule = Rule {
    code: "W0632",
    severity: Warning,
    title: "standard object has another access",
    why: "A master that writes the object gets an abort, or can change a value that only the device sets.",
    source: "CiA 301, chapter 7.5; CiA 302",
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} ({name}) is `{given}`, but {standard} specifies `{right}`",
    help: "write `{AccessType={fixed}}`{fix}",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Address { index, sub } = entry.address;
    let standard = of(index).filter(|found| found.is_like(*entry.object.code));
    let Some((standard, value)) = standard.and_then(|found| Some((found, found.value(sub)?)))
    else {
        return;
    };
    let own = *entry.access;
    let (wrong, fixed) = match value.access {
        // Values that the device itself sets.
        Access::Ro | Access::Const => (own.writable(), Access::Ro),
        // A device may fix a value that others could set.
        Access::Rw => (own == Access::Wo, Access::Rw),
        Access::Wo => (!own.writable(), Access::Wo),
        Access::Rwr | Access::Rww => return,
    };
    if wrong {
        let finding = RULE
            .on(entry, entry.access.span)
            .fact("object", entry.shown());
        let finding = finding
            .fact("name", standard.name)
            .fact("right", value.access);
        let finding = finding
            .fact("standard", standard.source())
            .fact("given", own);
        let fix = Fix::unsafe_fix().replace(entry.access.span, fixed.name());
        findings.push(finding.fact("fixed", fixed).fix(fix));
    }
}
