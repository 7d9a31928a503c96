use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::mapped;
use crate::scan::number::number;
use crate::subject::objects;

pub(crate) static W0526: Rule = Rule {
    title: "mapping is finer than the granularity",
    why: "Granularity in [DeviceInfo] is the smallest number of bits that the device can map.",
    source: "CiA 306-1, DeviceInfo",
    says: "object is mapped with {bits:bit|bits}, but Granularity is {granularity}",
    help: "map a multiple of the granularity, or correct Granularity in [DeviceInfo]",
    check: Check::Device(check),
    ..Rule::of("W0526")
};

/// Only the first such entry is reported: usually most mappings of a device are alike.
fn check(description: &Description, findings: &mut Vec<Finding>) {
    let info = description.section("DeviceInfo");
    let given = info.and_then(|info| number(info.get("Granularity")?));
    let given = given.and_then(|given| u8::try_from(given).ok());
    let Some(granularity) = given.filter(|given| (2..=64).contains(given)) else {
        return;
    };
    let mut all = objects(description).flat_map(|object| mapped(&object));
    if let Some(fine) = all.find(|mapped| !mapped.bits.is_multiple_of(granularity)) {
        let finding = fine.finding(&W0526).fact("bits", fine.bits);
        findings.push(finding.fact("granularity", granularity));
    }
}
