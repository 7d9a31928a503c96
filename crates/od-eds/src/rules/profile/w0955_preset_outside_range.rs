use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::Encoder;
use od_model::Address;

pub(crate) static W0955: Rule = Rule {
    title: "preset value is outside the range",
    why: "The encoder cannot take the preset value as its position. Positions are 0 to 6002h minus 1.",
    source: "CiA 406, object 6003h",
    says: "preset value {preset} is outside the range 0 to {last}",
    help: "write a position in the range, such as `{DefaultValue=0}`{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0955")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    if let (Some(preset), Some(range)) = (encoder.value(0x6003), encoder.value(0x6002))
        && range.value > 0
        && preset.value >= range.value
    {
        let finding = W0955.at(preset.span).about(Address::new(0x6003, 0));
        let finding = finding
            .fact("preset", preset.value)
            .fact("last", range.value - 1);
        let finding = finding.related(range.span, "6002h is set here");
        findings.push(finding.fix(Fix::unsafe_fix().replace(preset.span, "0")));
    }
}
