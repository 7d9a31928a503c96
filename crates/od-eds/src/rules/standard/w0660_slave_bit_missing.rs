use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::standards::cia301::of;
use crate::subject::{Entry, start_value};

pub(crate) static W0660: Rule = Rule {
    title: "NMT slave assignment lacks its slave bit",
    why: "The master ignores the other bits of a node that is not its slave: it does not boot a mandatory slave, nor miss it.",
    source: "CiA 302-2, object 1F81h",
    fixability: Fixability::Unsafe,
    says: "{object} ({name}) is 0x{given:X}, but bit 0 (slave of this master) is 0",
    help: "write `0x{meant:X}`{fix}, or 0 for a node that is not a slave",
    check: Check::Entry(check),
    ..Rule::of("W0660")
};

/// The bits that say how a slave is booted: 2 to 7.
const OPTIONS: u64 = 0xFC;

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if entry.address.index == 0x1F81
        && (1..=254).contains(&entry.address.sub)
        && let Some(value) = start_value(entry.entry)
        && let Some(number) = value.integer(0)
        && let Ok(given) = u64::try_from(number)
        && given & OPTIONS != 0
        && given & 1 == 0
    {
        let meant = given | 1;
        let finding = W0660.on(entry, value.span).fact("object", entry.shown());
        let name = of(entry.address.index).map_or("", |standard| standard.name);
        let finding = finding.fact("name", name).fact("given", number);
        let fix = Fix::unsafe_fix().replace(value.span, alloc::format!("0x{meant:08X}"));
        findings.push(finding.fact("meant", i128::from(meant)).fix(fix));
    }
}
