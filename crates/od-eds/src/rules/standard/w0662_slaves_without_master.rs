use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0662: Rule = Rule {
    title: "device with NMT slaves is not the NMT master",
    why: "A device that is not the NMT master starts and monitors no slave, so 1F81h has no effect.",
    source: "CiA 302-2, objects 1F80h and 1F81h",
    fixability: Fixability::Unsafe,
    says: "1F80h (NMT startup) is 0x{given:X}, but 1F81h assigns slaves to this device",
    help: "set bit 0 (NMT master): write `0x{meant:X}`{fix}, or clear bit 0 of the slaves in 1F81h",
    check: Check::Device(check),
    ..Rule::of("W0662")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let startup = Address::new(0x1F80, 0);
    let Some(given) = start_number(description, startup).filter(|given| given.value & 1 == 0)
    else {
        return;
    };
    let slaves = description.objects.get(&0x1F81);
    let subs = slaves.into_iter().flat_map(|object| object.entries.keys());
    let mut slaves = subs.filter(|sub| **sub > 0).filter_map(|sub| {
        let slave = start_number(description, Address::new(0x1F81, *sub))?;
        (slave.value & 1 != 0).then_some(slave.span)
    });
    if let Some(slave) = slaves.next() {
        let meant = given.value | 1;
        let finding = W0662.at(given.span).about(startup);
        let finding = finding
            .fact("given", i128::from(given.value))
            .fact("meant", i128::from(meant));
        let fix = Fix::unsafe_fix().replace(given.span, alloc::format!("0x{meant:X}"));
        findings.push(finding.fix(fix).related(slave, "a slave of this device"));
    }
}
