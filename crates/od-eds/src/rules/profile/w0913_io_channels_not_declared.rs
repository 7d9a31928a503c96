use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::{IO_BLOCKS, device};
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0913: Rule = Rule {
    title: "1000h does not declare the channels of an I/O module",
    why: "A master that reads from 1000h which channels exist does not use them.",
    source: "CiA 401, object 1000h",
    fixability: Fixability::Unsafe,
    says: "bit {bit} of 1000h ({what}) is 0, but object {object} exists",
    help: "set bit {bit} of 1000h{fix}",
    check: Check::Device(check),
    ..Rule::of("W0913")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x1000, 0);
    let number = start_number(description, address);
    let Some((device, number)) = device(description, 401).zip(number) else {
        return;
    };
    let blocks = IO_BLOCKS.iter();
    for (bit, objects, what) in blocks.filter(|(bit, _, _)| device.has(*bit) == Some(false)) {
        let found = objects
            .iter()
            .find(|index| description.objects.contains_key(index));
        if let Some(index) = found {
            let finding = W0913.at(number.span).about(address).fact("bit", bit + 16);
            let finding = finding.fact("what", *what);
            let value = number.value | 1 << (bit + 16);
            let fix = Fix::unsafe_fix().replace(number.span, format!("0x{value:08X}"));
            let finding = finding.fix(fix);
            findings.push(finding.fact("object", Fact::Index(*index)));
        }
    }
}
