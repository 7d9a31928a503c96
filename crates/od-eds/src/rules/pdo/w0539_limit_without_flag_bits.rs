use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::Entry;
use od_model::DataType;

pub(crate) static W0539: Rule = Rule {
    title: "HighLimit of a COB-ID excludes its upper bits",
    why: "A master sets bit 31 to disable the PDO, SDO or EMCY before it writes another COB-ID or mapping: the device aborts that with 0609 0031h.",
    source: "CiA 301, objects 1012h, 1014h, 1201h to 12FFh, 1400h to 15FFh and 1800h to 19FFh",
    fixability: Fixability::Unsafe,
    says: "{HighLimit} of {object} excludes bit {bit} of the COB-ID",
    help: "write `{HighLimit=0xFFFFFFFF}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0539")
};

/// The lowest of the upper bits that a master must be able to set.
const fn bit(index: u16, sub: u8) -> Option<u32> {
    match (index, sub) {
        // Bit 30 enables a producer, bit 31 a consumer.
        (0x1012, 0) => Some(30),
        (0x1014, 0) | (0x1201..=0x12FF, 1 | 2) | (0x1400..=0x15FF | 0x1800..=0x19FF, 1) => Some(31),
        _ => None,
    }
}

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Some(bit) = bit(entry.address.index, entry.address.sub) else {
        return;
    };
    let is_number = entry
        .data_type
        .is_some_and(|given| *given == DataType::Unsigned32);
    let Some(high) = entry
        .high
        .as_ref()
        .filter(|_| is_number && entry.access.writable())
    else {
        return;
    };
    if high.value.integer(0).is_some_and(|limit| limit < 1 << bit) {
        let fix = Fix::unsafe_fix().replace(high.span, "0xFFFFFFFF");
        let finding = W0539.on(entry, high.span).key(Key::HighLimit);
        let finding = finding.fact("object", entry.shown()).fact("bit", bit);
        findings.push(finding.fix(fix));
    }
}
