use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;

pub(crate) static W0247: Rule = Rule {
    title: "DynamicChannelsSupported does not match [DynamicChannels]",
    why: "A tool for programmable devices places no variables, or looks for a section that does not exist.",
    source: "CiA 306-1, DeviceInfo and DynamicChannels",
    says: "DynamicChannelsSupported is {given}, but section [DynamicChannels] is missing",
    help: "add a section [DynamicChannels], or write 0{fix}",
    also: &[DENIED],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0247")
};

/// Sentence for a section that `[DeviceInfo]` denies.
const DENIED: Form = Form {
    says: "section [DynamicChannels] exists, but [DeviceInfo] does not declare dynamic channels",
    help: "write the number of segments to `DynamicChannelsSupported`",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("DeviceInfo") else {
        return;
    };
    let given = info.get("DynamicChannelsSupported");
    let count = given.and_then(|given| number(given)).unwrap_or(0);
    match (description.section("DynamicChannels"), given) {
        (None, Some(given)) if count > 0 => {
            let fix = Fix::unsafe_fix().replace(given.span, "0");
            findings.push(W0247.given(given).fix(fix));
        }
        (Some(channels), given) if count == 0 => {
            let span = given.map_or(channels.name.span, |given| given.span);
            let finding = W0247.at(span).form(&DENIED);
            findings.push(finding.related(channels.name.span, "section of the channels"));
        }
        _ => {}
    }
}
