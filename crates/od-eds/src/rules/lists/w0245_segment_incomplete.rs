use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::scan::number::number;

pub(crate) static W0245: Rule = Rule {
    title: "segment of [DynamicChannels] is incomplete",
    why: "A programmable device cannot place its variables: each segment needs a type, a direction, a range and an offset in the process image.",
    source: "CiA 306-1, DynamicChannels",
    says: "{field} of segment {segment} is missing",
    help: "add `{field}=`, or lower NrOfSeg",
    check: Check::Device(check),
    ..Rule::of("W0245")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(channels) = description.section("DynamicChannels") else {
        return;
    };
    let Some(given) = channels.get("NrOfSeg") else {
        return;
    };
    for segment in 1..=number(given).unwrap_or(0).clamp(0, 255) {
        let fields = ["Type", "Dir", "Range", "PPOffset"].map(|field| format!("{field}{segment}"));
        for field in fields {
            if channels.get(&field).is_none() {
                let finding = W0245.at(given.span).fact("field", field);
                findings.push(finding.fact("segment", segment));
            }
        }
    }
}
