use alloc::vec::Vec;
use core::cmp::Ordering;

use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::device;
use crate::rules::values::limits::order;
use crate::subject::{Entry, shown, start_value};
use od_model::Address;

pub(crate) static W0920: Rule = Rule {
    title: "two points of a scaling have one field value",
    why: "The process value lies on the line through two points. Through two points above each other there is no such line: the device divides by 0, or shows an error.",
    source: "CiA 404, objects 6120h to 6123h",
    says: "{object} and {first} are {given}: the two points of the scaling have one field value",
    help: "write two different field values, such as the smallest and the largest of the sensor",
    check: Check::Entry(check),
    ..Rule::of("W0920")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Address { index, sub } = entry.address;
    // The objects of another type are 1000h apart.
    if !matches!(
        (index, index & 0xFFF, sub),
        (0x6000..=0x9FFF, 0x122, 1..=254)
    ) || device(entry.description, 404).is_none()
    {
        return;
    }
    let first = Address::new(index - 2, sub);
    if let Some(object) = entry.description.objects.get(&first.index)
        && let Some(one) = object.entries.get(&sub).and_then(start_value)
        && let Some(two) = start_value(entry.entry)
        && order(one, two) == Some(Ordering::Equal)
        // Both are 0 in a device that is not configured yet.
        && two.integer(0) != Some(0)
    {
        let finding = W0920.on(entry, two.span).fact("object", entry.shown());
        let finding = finding.fact("first", shown(object, first));
        let finding = finding.fact("given", two.value.clone());
        findings.push(finding.related(one.span, "field value of the first point"));
    }
}
