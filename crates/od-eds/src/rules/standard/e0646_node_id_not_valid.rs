use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity::Warning};
use crate::rules::standard::shared::commissioning;
use crate::scan::number::number;

pub(crate) static E0646: Rule = Rule {
    buildable: true,
    title: "node ID of a DCF is not valid",
    why: "A master cannot address the device. A node ID is 1 to 127.",
    source: "CiA 306-1, DeviceComissioning; CiA 301, node ID",
    says: "NodeID `{given}` is not valid",
    help: "write 1 to 127, or 255 for a node that gets its node ID by LSS",
    also: &[NO_LSS],
    check: Check::Device(check),
    ..Rule::of("E0646")
};

/// Sentence for a node that waits for LSS and does not support it.
const NO_LSS: Form = Form {
    says: "NodeID is `{given}`, but LSS_Supported in [DeviceInfo] is 0",
    help: "write 1 to 127, or `LSS_Supported=1` if the node gets its node ID by LSS",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let given = commissioning(description).and_then(|section| section.get("NodeID"));
    // The reader reports a value that is not a number.
    let wrong = |id| matches!(id, 0 | 128..=254);
    if let Some(given) = given.filter(|given| number(given).is_some_and(wrong)) {
        findings.push(E0646.given(given));
    }
    let lss = description
        .section("DeviceInfo")
        .and_then(|info| info.get("LSS_Supported"));
    let without_lss = lss.is_some_and(|lss| number(lss) == Some(0));
    if let Some(given) = given.filter(|given| number(given) == Some(255) && without_lss) {
        let finding = E0646.given(given).form(&NO_LSS);
        findings.push(finding.severity_of(Warning));
    }
}
