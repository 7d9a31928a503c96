use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::Encoder;
use od_model::Address;

pub(crate) static W0954: Rule = Rule {
    title: "operating status differs from the operating parameters",
    why: "A master reads a setting that the encoder does not use. 6500h shows bits 0 to 2 of 6000h: code sequence, commissioning diagnosis, scaling.",
    source: "CiA 406, objects 6000h and 6500h",
    fixability: Fixability::Unsafe,
    says: "6500h is 0x{status:X}, but 6000h is 0x{parameters:X}",
    help: "write `{DefaultValue=0x{right:X}}`{fix}",
    check: Check::Device(check),
    ..Rule::of("W0954")
};

/// Code sequence, commissioning diagnosis, scaling.
const SHARED: u64 = 0b111;

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    let (parameters, status) = (encoder.value(0x6000), encoder.value(0x6500));
    let (Some(parameters), Some(status)) = (parameters, status) else {
        return;
    };
    if (parameters.value ^ status.value) & SHARED != 0 {
        let right = status.value & !SHARED | parameters.value & SHARED;
        let fix = Fix::unsafe_fix().replace(status.span, format!("0x{right:X}"));
        let finding = W0954
            .at(status.span)
            .about(Address::new(0x6500, 0))
            .fix(fix);
        let finding = finding
            .fact("status", status.value)
            .fact("parameters", parameters.value)
            .fact("right", right);
        findings.push(finding.related(parameters.span, "6000h is set here"));
    }
}
