use alloc::vec::Vec;
use core::cmp::Ordering;

use crate::fact::shown as text;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::device;
use crate::rules::values::limits::order;
use crate::subject::{Entry, shown, start_value};
use od_model::Address;

pub(crate) static W0911: Rule = Rule {
    title: "lower limit of a device is above the upper one",
    why: "No value is between the limits: a drive rejects every position, and an area or an alarm has no effect.",
    source: "CiA 401, 6424h, 6425h, 6429h, 642Ah; CiA 402, 6046h, 607Bh, 607Dh; CiA 404, 6134h to 6149h; CiA 406, 6401h, 6402h",
    says: "upper limit {object} is {high}, but lower limit {lower} is {low}",
    help: "write the lower limit to {lower} and the upper limit to {object}{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Entry(check),
    ..Rule::of("W0911")
};

/// The lower limit that belongs to the upper limit at an address, and the profile that defines both.
fn lower(upper: Address) -> Option<(u16, Address)> {
    let Address { index, sub } = upper;
    // The objects of the other devices of a module and of the other axes are 800h apart, and so are those of a
    // measuring device that have another type (1000h).
    let first = 0x6000 + index.checked_sub(0x6000)? % 0x800;
    let (profile, index, sub) = match (first, sub) {
        (0x6046 | 0x607B | 0x607D, 2) => (402, index, 1),
        (0x6424 | 0x6429, 1..=254) => (401, index + 1, sub),
        (0x6402, 1..=254) => (406, index - 1, sub),
        (0x6135 | 0x6149, 1..=254) => (404, index - 1, sub),
        _ => return None,
    };
    Some((profile, Address::new(index, sub)))
}

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some((profile, lower)) = lower(entry.address)
        && device(entry.description, profile).is_some()
        && let Some(object) = entry.description.objects.get(&lower.index)
        && let Some(low) = object.entries.get(&lower.sub).and_then(start_value)
        && let Some(high) = start_value(entry.entry)
        && order(low, high) == Some(Ordering::Greater)
    {
        let finding = W0911.on(entry, high.span).fact("object", entry.shown());
        let finding = finding.fact("lower", shown(object, lower));
        let finding = finding.fact("low", low.value.clone());
        let finding = finding.fact("high", high.value.clone());
        let finding = finding.related(low.span, "lower limit set here");
        let swap = Fix::unsafe_fix()
            .replace(high.span, text(&low.value))
            .replace(low.span, text(&high.value));
        findings.push(finding.fix(swap));
    }
}
