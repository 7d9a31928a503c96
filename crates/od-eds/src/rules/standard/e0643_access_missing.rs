use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::maps_rpdo;
use crate::standards::cia301::of;
use crate::subject::Entry;
use od_model::{Access, Address};

pub(crate) static E0643: Rule = Rule {
    buildable: true,
    title: "access to a standard object is missing",
    why: "A master that reads or writes the object as the standard specifies gets an abort.",
    source: "CiA 301, chapter 7.5; CiA 302",
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} ({name}) is `{given}`, but {standard} specifies `{right}`",
    help: "write `{AccessType={right}}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("E0643")
};

/// Objects that have an effect only if a master writes them.
const WRITTEN: [u16; 8] = [
    0x1006, 0x1010, 0x1011, 0x1015, 0x1016, 0x1020, 0x1F50, 0x1F51,
];

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Address { index, sub } = entry.address;
    let Some(standard) = of(index).filter(|found| found.is_like(*entry.object.code)) else {
        return;
    };
    let access = match standard.value(sub) {
        Some(value) => value.access,
        None if maps_rpdo(index).is_some() || sub == 0 => Access::Rw,
        None => return,
    };
    let own = *entry.access;
    let right = match access {
        Access::Ro | Access::Const if own == Access::Wo => Access::Ro,
        Access::Rw if own == Access::Wo => Access::Rw,
        Access::Rw if !own.writable() && sub > 0 && WRITTEN.contains(&index) => Access::Rw,
        Access::Rw if !own.writable() && matches!(index, 0x1006 | 0x1015) => Access::Rw,
        Access::Wo if !own.writable() => Access::Wo,
        _ => return,
    };
    let finding = E0643
        .on(entry, entry.access.span)
        .fact("object", entry.shown());
    let finding = finding.fact("name", standard.name).fact("right", right);
    let finding = finding
        .fact("standard", standard.source())
        .fact("given", own);
    findings.push(finding.fix(Fix::unsafe_fix().replace(entry.access.span, right.name())));
}
