use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::scan::number::number;
use od_model::Address;

pub(crate) static W0634: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "LSS without a complete LSS address",
    why: "An LSS master cannot select the device: an LSS address is vendor-ID, product code, revision number and serial number, all in 1018h.",
    source: "CiA 305, LSS address",
    says: "the LSS address lacks {missing}",
    help: "add the missing sub-objects, or write `LSS_Supported=0`",
    check: Check::Device(check),
    ..Rule::of("W0634")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let info = description.section("DeviceInfo");
    let given = info.and_then(|info| info.get("LSS_Supported"));
    let (Some(given), Some(identity)) = (given, description.objects.get(&0x1018)) else {
        return;
    };
    let missing = (1..=4).filter(|sub| !identity.entries.contains_key(sub));
    let missing: Vec<_> = missing
        .map(|sub| Fact::Object(Address::new(0x1018, sub)))
        .collect();
    if number(given) == Some(1) && !missing.is_empty() {
        let finding = W0634.at(given.span).about(Address::new(0x1018, 0));
        let finding = finding.fact("missing", missing);
        findings.push(finding.related(identity.span, "1018h is defined here"));
    }
}
