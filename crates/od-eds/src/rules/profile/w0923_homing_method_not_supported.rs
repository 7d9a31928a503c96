use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::device;
use crate::subject::start_value;
use od_model::Address;

pub(crate) static W0923: Rule = Rule {
    title: "homing method is not one of the supported ones",
    why: "The drive does not start its homing, or a master that reads 60E3h does not expect the method.",
    source: "CiA 402, objects 6098h and 60E3h",
    says: "6098h is {method}, but no sub-object of 60E3h is {method}",
    help: "write a method of 60E3h, or add {method} to 60E3h",
    check: Check::Device(check),
    ..Rule::of("W0923")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x6098, 0);
    let method = description.entry(address).and_then(start_value);
    let list = description.objects.get(&0x60E3);
    let Some((method, list)) = method
        .zip(list)
        .filter(|_| device(description, 402).is_some())
    else {
        return;
    };
    // A byte without a sign holds a method of the manufacturer as 256 more.
    let supported = list.entries.range(1..255).map(|(_, entry)| {
        let number = start_value(entry)?.integer(0)?;
        Some(if number > 127 { number - 256 } else { number })
    });
    // A method that the file does not give is one that the drive tells. 0 is no method.
    let Some(supported): Option<Vec<i128>> = supported.collect() else {
        return;
    };
    if let Some(number) = method.integer(0)
        && number != 0
        && supported.iter().any(|known| *known != 0)
        && !supported.contains(&number)
    {
        let finding = W0923.at(method.span).about(address);
        findings.push(finding.fact("method", number));
    }
}
