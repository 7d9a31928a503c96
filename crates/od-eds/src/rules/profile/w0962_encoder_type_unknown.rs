use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::Encoder;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0962: Rule = Rule {
    title: "type of the encoder is not defined",
    why: "A master does not know if the encoder counts revolutions, or measures a length.",
    source: "CiA 406, object 1000h",
    says: "1000h declares encoder type {given}, which CiA 406 does not define",
    help: "write 1 (singleturn), 2 (multiturn) or another type of CiA 406 in bits 16 to 31",
    check: Check::Device(check),
    ..Rule::of("W0962")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x1000, 0);
    if let Some(number) = start_number(description, address)
        && Encoder::of(description).is_some_and(|encoder| encoder.has_unknown_type())
    {
        let finding = W0962.at(number.span).about(address);
        findings.push(finding.fact("given", number.value >> 16));
    }
}
