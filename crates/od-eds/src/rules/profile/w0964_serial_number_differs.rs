use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::device;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0964: Rule = Rule {
    title: "serial number of the encoder differs from that of the device",
    why: "A master that identifies the encoder by 650Bh takes it for another device than one that reads 1018h.",
    source: "CiA 406, object 650Bh; CiA 301, object 1018h",
    fixability: Fixability::Unsafe,
    says: "650Bh is {given}, but 1018h:04 is {right}",
    help: "write {right}{fix}",
    check: Check::Device(check),
    ..Rule::of("W0964")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let [own, identity] = [Address::new(0x650B, 0), Address::new(0x1018, 4)];
    let numbers = start_number(description, own).zip(start_number(description, identity));
    if let Some((given, right)) = numbers
        // 0: the device writes its own number, and the file of all devices has none.
        && given.value != 0
        && right.value != 0
        && given.value != right.value
        && device(description, 406).is_some()
    {
        let fix = Fix::unsafe_fix().replace(given.span, alloc::format!("{}", right.value));
        let finding = W0964.at(given.span).about(own).fact("given", given.value);
        let finding = finding.fact("right", right.value).fix(fix);
        findings.push(finding.related(right.span, "serial number of the device"));
    }
}
