use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0656: Rule = Rule {
    title: "device starts with node guarding and heartbeat",
    why: "CiA 301 does not allow both at once: the device sends a heartbeat, and a master that guards it gets no answer.",
    source: "CiA 301, chapter 7.2.8.2 and object 1017h",
    says: "100Ch and 100Dh enable life guarding, but 1017h is {time} ms",
    help: "write `{DefaultValue=0}` to 100Ch{fix}, or to 1017h",
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0656")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let at = |index| {
        let number = start_number(description, Address::new(index, 0));
        number.filter(|number| number.value > 0)
    };
    if let Some(((guard, _), heartbeat)) = at(0x100C).zip(at(0x100D)).zip(at(0x1017)) {
        let finding = W0656.at(guard.span).about(Address::new(0x100C, 0));
        let finding = finding.fact("time", heartbeat.value);
        let finding = finding.related(heartbeat.span, "heartbeat enabled here");
        findings.push(finding.fix(Fix::unsafe_fix().replace(guard.span, "0")));
    }
}
