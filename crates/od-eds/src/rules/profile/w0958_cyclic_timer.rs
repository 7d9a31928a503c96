use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::Encoder;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0958: Rule = Rule {
    title: "cyclic timer differs from the event timer",
    why: "A master that reads one of the two objects gets the wrong period. Both set the same timer.",
    source: "CiA 406, object 6200h",
    fixability: Fixability::Unsafe,
    says: "6200h is {cycle} ms, but 1800h:05 is {event} ms",
    help: "write the same value in both{fix}",
    check: Check::Device(check),
    ..Rule::of("W0958")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    let event = start_number(description, Address::new(0x1800, 5));
    if let (Some(cycle), Some(event)) = (encoder.value(0x6200), event)
        && cycle.value != event.value
    {
        let fix = Fix::unsafe_fix().replace(cycle.span, format!("{}", event.value));
        let finding = W0958.at(cycle.span).about(Address::new(0x6200, 0)).fix(fix);
        let finding = finding
            .fact("cycle", cycle.value)
            .fact("event", event.value);
        findings.push(finding.related(event.span, "1800h:05 is set here"));
    }
}
