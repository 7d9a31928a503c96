use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::device;
use crate::rules::values::shared::Reserved::{self, Bits, Number};
use crate::subject::{Entry, start_value};
use od_model::Address;

pub(crate) static W0914: Rule = Rule {
    title: "value of a profile object is reserved",
    why: "A device that follows the profile aborts a download of the value, and a master may give the bits another meaning.",
    source: "CiA 401, 6421h, 6443h; CiA 402, 6007h to 6502h; CiA 404, 6150h; CiA 406, 6000h, 6503h to 6506h; CiA 303-2",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA {profile} reserves {reserved}",
    help: "write a value without {reserved}{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0914")
};

/// The profile of an object, if the number has reserved bits or is in a reserved range, and which.
/// Negative numbers of a drive are the manufacturer's.
fn reserved(address: Address, number: i128) -> Option<(u16, Reserved, &'static str)> {
    let Address { index, sub } = address;
    let (profile, wrong, what) = match (index, sub) {
        // FFFFh above the number of the profile: several logical devices.
        (0x1000, 0) if number >> 16 == 0xFFFF => return None,
        (0x1000, 0) if number & 0xFFFF == 401 => (401, Bits(0x70_0000), "bits 20 to 22"),
        (0x1000, 0) if number & 0xFFFF == 402 => (402, Bits(0x38_0000), "bits 19 to 21"),
        (0x6421, 1..=254) => (401, Bits(0xE0), "bits 5 to 7"),
        (0x6443, 1..=254) => (401, Number(number > 1), "2 to 255"),
        (0x6007, 0) => (402, Number(number > 3), "4 to 32767"),
        (0x607E, 0) => (402, Bits(0x3F), "bits 0 to 5"),
        (0x6088, 0) => (402, Number(number > 1), "2 to 32767"),
        (0x605A, 0) => (402, Number(number > 8), "9 to 32767"),
        (0x605B | 0x605C, 0) => (402, Number(number > 1), "2 to 32767"),
        (0x605D, 0) => (402, Number(number == 0 || number > 4), "0 and 5 to 32767"),
        (0x605E, 0) => (402, Number(number > 4), "5 to 32767"),
        (0x6060 | 0x6061, 0) => {
            let wrong = matches!(number, 5 | 12..);
            (402, Number(wrong), "5 and 12 to 127")
        }
        (0x6086, 0) => (402, Number(number > 3), "4 to 32767"),
        (0x6098, 0) => {
            let wrong = matches!(number, 15 | 16 | 31 | 32 | 38..);
            (402, Number(wrong), "15, 16, 31, 32 and 38 to 127")
        }
        (0x60C2, 2) => (402, Number(number > 63), "64 to 127"),
        (0x6402, 0) => (402, Number(matches!(number, 17..=0x7FFE)), "17 to 32766"),
        (0x6502, 0) => (402, Bits(0xF810), "bits 4 and 11 to 15"),
        (0x6430 | 0x6450, 1..=254) => return of_unit(401, number),
        (0x60A8..=0x60AB, 0) => return of_unit(402, number),
        (0x6150, 1..=254) => (404, Bits(0xF8), "bits 3 to 7"),
        (0x6131 | 0x6301, 1..=254) => return of_unit(404, number),
        (0x6000, 0) => (406, Bits(0x0FF0), "bits 4 to 11"),
        (0x6503 | 0x6504, 0) => (406, Bits(0x0FFC), "bits 2 to 11"),
        (0x6505 | 0x6506, 0) => (406, Bits(0x0FC0), "bits 6 to 11"),
        _ => return None,
    };
    // A negative number is the manufacturer's, and has no reserved bits.
    let bits = u64::try_from(number).unwrap_or(0);
    wrong.has(bits).then_some((profile, wrong, what))
}

/// The part of the unit of an object of this profile that is reserved.
fn of_unit(profile: u16, number: i128) -> Option<(u16, Reserved, &'static str)> {
    let what = reserved_of_unit(number)?;
    let wrong = match what {
        "bits 0 to 7" => Bits(0xFF),
        _ => Number(true),
    };
    Some((profile, wrong, what))
}

/// The part of a unit that is reserved (CiA 303-2): a power of ten without a prefix, a number in the rest of the tables of base
/// units and of angles, the lowest byte.
fn reserved_of_unit(number: i128) -> Option<&'static str> {
    let [rest, denominator, numerator, prefix] = u32::try_from(number).ok()?.to_le_bytes();
    let is_reserved = |unit| matches!(unit, 0x08..=0x0F | 0x12..=0x1F);
    if !(-18..=18).contains(&(prefix as i8)) {
        Some("bits 24 to 31 below -18 or above 18")
    } else if is_reserved(numerator) || is_reserved(denominator) {
        Some("the units 08h to 0Fh and 12h to 1Fh")
    } else if rest != 0 {
        Some("bits 0 to 7")
    } else {
        None
    }
}

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some(value) = start_value(entry.entry)
        && let Some(number) = value.integer(0)
        && let Some((profile, wrong, what)) = reserved(entry.address, number)
        && device(entry.description, profile).is_some()
    {
        let finding = W0914.on(entry, value.span).fact("object", entry.shown());
        let finding = if what.starts_with("bits") {
            finding.fact("given", alloc::format!("0x{number:X}"))
        } else {
            finding.fact("given", number)
        };
        let finding = finding.fact("reserved", what);
        let finding = finding.fact("profile", u32::from(profile));
        findings.push(match wrong.cleared(&value.value) {
            Some(right) => finding.fix(Fix::unsafe_fix().replace(value.span, right)),
            None => finding,
        });
    }
}
