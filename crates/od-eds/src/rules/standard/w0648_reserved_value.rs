use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity};
use crate::fix::Fix;
use crate::rules::values::shared::Reserved::{self, Bits, Number};
use crate::standards::cia301::of;
use crate::subject::{Entry, start_value};
use od_model::Address;

pub(crate) static W0648: Rule = Rule {
    buildable: true,
    title: "value of a standard object is reserved",
    why: "A device that follows the standard aborts a download of the value, and a master may give the bits another meaning.",
    source: "CiA 301, chapter 7.5; CiA 302-2, objects 1F80h and 1F82h; CiA 302-3, objects 1F27h, 1F51h and 1F54h",
    fixability: Fixability::Unsafe,
    says: "{object} ({name}) is 0x{given:X}, but {standard} reserves {reserved}",
    help: "write a value without {reserved}{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0648")
};

/// Returns the part of a number that is reserved: bits or a range.
fn reserved(address: Address, number: u64) -> Option<(Reserved, &'static str)> {
    let Address { index, sub } = address;
    let (wrong, what) = match (index, sub) {
        // The upper half depends on the profile. FFFFh: several logical devices.
        (0x1000, 0) => {
            let none = number & 0xFFFF == 0 && number >> 16 != 0xFFFF;
            let bits = if none { 0xFFFF_0000 } else { 0 };
            (Bits(bits), "bits 16 to 31 without a device profile")
        }
        (0x1001, 0) => (Bits(0x40), "bit 6"),
        (0x1010, 1..=254) => (Bits(!0x3), "bits 2 to 31"),
        (0x1011, 1..=254) => (Bits(!0x1), "bits 1 to 31"),
        (0x1014, 0) => (Bits(1 << 30), "bit 30"),
        (0x1016, 1..=254) => (Bits(0xFF00_0000), "bits 24 to 31"),
        (0x1019, 0) => (Number(matches!(number, 1 | 241..)), "1 and 241 to 255"),
        // Milliseconds after midnight.
        (0x1020, 2) | (0x1F27 | 0x1F54, 1..=254) => {
            let is_above = Number(number >= 86_400_000);
            (is_above, "86400000 (24 hours) and above")
        }
        (0x1023 | 0x1025, 2) => (Number(matches!(number, 4..=254)), "4 to 254"),
        (0x1022, 0) => (Number(matches!(number, 1..=0x7F)), "1 to 127"),
        (0x1028, 1..=254) => (Bits(1 << 30), "bit 30"),
        (0x1029, 1..=254) => (Number(matches!(number, 3..=0x7F)), "3 to 127"),
        (0x1201..=0x12FF, 3) => (Number(number > 127), "128 to 255"),
        // Commands of manufacturers begin at 80h: Zephyr's confirmation of a program is one.
        (0x1F51, 1..=254) => (Number(matches!(number, 4..=0x7F)), "4 to 127"),
        (0x1F82, 1..=128) => {
            let wrong = matches!(number, 2 | 3 | 8..=126);
            (Number(wrong), "2, 3 and 8 to 126")
        }
        (0x1F80, 0) => (Bits(!0x7F), "bits 7 to 31"),
        (0x1800..=0x19FF, 6) => (Number(matches!(number, 241..)), "241 to 255"),
        _ => return None,
    };
    wrong.has(number).then_some((wrong, what))
}

/// Returns the node ID (0) that is reserved in an SDO client whose COB-IDs are both valid.
fn reserved_server(entry: &Entry<'_>, number: u64) -> Option<(Reserved, &'static str)> {
    let Address { index, sub } = entry.address;
    let is_valid = |sub| {
        let value = entry.description.entry(Address::new(index, sub));
        let number = value
            .and_then(start_value)
            .and_then(|value| value.integer(1));
        // A COB-ID of 0 is that of a client that is not used.
        number.is_some_and(|number| number != 0 && number >> 31 & 1 == 0)
    };
    let is_client = matches!((index, sub), (0x1280..=0x12FF, 3));
    (is_client && number == 0 && is_valid(1) && is_valid(2)).then_some((Number(true), "0"))
}

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some(standard) = of(entry.address.index)
        && let Some(value) = start_value(entry.entry)
        && let Some(number) = value.integer(0)
        && let Ok(unsigned) = u64::try_from(number)
        && let Some((wrong, what)) =
            reserved(entry.address, unsigned).or_else(|| reserved_server(entry, unsigned))
    {
        let finding = W0648.on(entry, value.span).fact("object", entry.shown());
        let finding = finding
            .fact("name", standard.name)
            .fact("given", number)
            .fact("standard", standard.source());
        let finding = finding.fact("reserved", what);
        let finding = match wrong.cleared(&value.value) {
            Some(right) => finding.fix(Fix::unsafe_fix().replace(value.span, right)),
            None => finding,
        };
        // The counter of SYNC cannot have the value: no SYNC is sent with it, and the TPDO waits for it forever.
        let is_counter = matches!(
            (entry.address.index, entry.address.sub),
            (0x1019, 0) | (0x1800..=0x19FF, 6)
        );
        findings.push(if is_counter {
            finding.severity_of(Severity::Error)
        } else {
            finding
        });
    }
}
