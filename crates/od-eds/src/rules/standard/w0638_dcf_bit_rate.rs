use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity::Warning};
use crate::rules::standard::shared::commissioning;
use crate::scan::number::number;

pub(crate) static W0638: Rule = Rule {
    code: "W0638",
    severity: Warning,
    title: "bit rate of a DCF is not valid",
    why: "A configuration tool cannot set the bit rate. CiA 301 defines the bit rates, and [DeviceInfo] gives those of the device.",
    source: "CiA 306-1, DeviceComissioning",
    says: "Baudrate `{given}` is not valid",
    help: "write 10, 20, 50, 125, 250, 500, 800 or 1000 (kbit/s)",
    also: &[LACKS],
    check: Check::Device(check),
    ..Rule::NEW
};

/// Sentence for a bit rate that the device does not support.
const LACKS: Form = Form {
    says: "Baudrate is {given}, but BaudRate_{given} in [DeviceInfo] is 0",
    help: "write a bit rate that the device supports",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let given = commissioning(description).and_then(|section| section.get("Baudrate"));
    let Some((given, rate)) = given.and_then(|given| Some((given, number(given)?))) else {
        return;
    };
    // The reader reports what is not a number of 16 bits.
    if !(0..=0xFFFF).contains(&rate) {
        return;
    }
    let finding = W0638.at(given.span).fact("given", given.as_str());
    if !matches!(rate, 10 | 20 | 50 | 100 | 125 | 250 | 500 | 800 | 1000) {
        findings.push(finding);
        return;
    }
    let info = description.section("DeviceInfo");
    let own = info.and_then(|info| info.get(&format!("BaudRate_{rate}")));
    if own.is_some_and(|own| number(own) == Some(0)) {
        findings.push(finding.form(&LACKS));
    }
}
