use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule};
use crate::rules::profile::shared::Encoder;
use od_model::Address;

pub(crate) static W0957: Rule = Rule {
    title: "device type and revolutions disagree",
    why: "A master that reads only one of the two objects treats the encoder as the wrong kind.",
    source: "CiA 406, objects 1000h and 6502h",
    says: "1000h declares a multiturn encoder, but 6502h declares {turns:revolution|revolutions}",
    help: "correct 6502h, or bits 16 to 31 of 1000h (1: singleturn, 2: multiturn)",
    also: &[SINGLETURN],
    check: Check::Device(check),
    ..Rule::of("W0957")
};

/// Sentence for a singleturn encoder.
const SINGLETURN: Form = Form {
    says: "1000h declares a singleturn encoder, but 6502h declares {turns:revolution|revolutions}",
    ..Form::OWN
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    let (Some(turns), Some(many)) = (encoder.value(0x6502), encoder.is_multiturn()) else {
        return;
    };
    // In some devices 6502h contains steps, as 6002h does.
    let revolutions = match (encoder.value(0x6002), encoder.value(0x6501)) {
        (Some(range), Some(physical))
            if range.value == turns.value && (2..=turns.value).contains(&physical.value) =>
        {
            turns.value / physical.value
        }
        _ => turns.value,
    };
    if many == (revolutions <= 1) {
        let finding = W0957.at(turns.span).about(Address::new(0x6502, 0));
        let finding = finding.fact("turns", revolutions);
        findings.push(if many {
            finding
        } else {
            finding.form(&SINGLETURN)
        });
    }
}
