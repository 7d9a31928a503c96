use alloc::string::ToString;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::Encoder;
use od_model::Address;

pub(crate) static W0956: Rule = Rule {
    title: "measuring units exceed the singleturn resolution",
    why: "The encoder cannot deliver steps that are finer than its singleturn resolution.",
    source: "CiA 406, objects 6001h and 6501h",
    says: "6001h is {units}, but the singleturn resolution (6501h) is {physical}",
    help: "write at most {physical}{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0956")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    if let (Some(units), Some(physical)) = (encoder.value(0x6001), encoder.value(0x6501))
        && physical.value > 0
        && units.value > physical.value
    {
        let finding = W0956.at(units.span).about(Address::new(0x6001, 0));
        let finding = finding
            .fact("units", units.value)
            .fact("physical", physical.value);
        let fix = Fix::unsafe_fix().replace(units.span, physical.value.to_string());
        findings.push(finding.related(physical.span, "6501h is set here").fix(fix));
    }
}
