use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule};
use crate::rules::pdo::shared::{mapped, maps_rpdo};
use crate::scan::number::number;
use crate::subject::objects;

pub(crate) static W0526: Rule = Rule {
    title: "mapping does not fit the granularity",
    why: "Granularity in [DeviceInfo] is the smallest number of bits that the device can map, and 0 if a master cannot change the mapping.",
    source: "CiA 306-1, DeviceInfo",
    says: "object is mapped with {bits:bit|bits}, but Granularity is {granularity}",
    help: "map a multiple of the granularity, or correct Granularity in [DeviceInfo]",
    also: &[FIXED],
    check: Check::Device(check),
    ..Rule::of("W0526")
};

/// Sentence for a mapping that a master can write.
const FIXED: Form = Form {
    says: "Granularity is 0 (fixed mapping), but {object} is `{access}`",
    help: "write the number of bits that the device can map, such as `Granularity=8`, or `{AccessType=const}` in the mappings",
};

/// Only the first such entry is reported: usually most mappings of a device are alike.
fn check(description: &Description, findings: &mut Vec<Finding>) {
    let info = description.section("DeviceInfo");
    let given = info.and_then(|info| number(info.get("Granularity")?));
    let given = given.and_then(|given| u8::try_from(given).ok());
    if given == Some(0) {
        findings.extend(writable(description));
    }
    let Some(granularity) = given.filter(|given| (2..=64).contains(given)) else {
        return;
    };
    let mut all = objects(description).flat_map(|object| mapped(&object));
    if let Some(fine) = all.find(|mapped| !mapped.bits.is_multiple_of(granularity)) {
        let finding = fine.finding(&W0526).fact("bits", fine.bits);
        findings.push(finding.fact("granularity", granularity));
    }
}

/// The finding about the first mapping that a master can write, although the device has a fixed mapping.
fn writable(description: &Description) -> Option<Finding> {
    let given = description.section("DeviceInfo")?.get("Granularity")?;
    let mappings = objects(description).filter(|object| maps_rpdo(object.index).is_some());
    let mut entries = mappings.flat_map(|object| object.entries());
    let entry = entries.find(|entry| entry.access.writable())?;
    let finding = W0526.at(given.span).form(&FIXED);
    let finding = finding
        .fact("object", entry.shown())
        .fact("access", *entry.access);
    Some(finding.related(entry.access.span, "a master can write this"))
}
