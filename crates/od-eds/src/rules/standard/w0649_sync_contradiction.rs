use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule};
use crate::span::Spanned;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0649: Rule = Rule {
    title: "objects of the SYNC service contradict each other",
    why: "The device produces no SYNC message, or drops synchronous PDOs that come in time.",
    source: "CiA 301, objects 1005h to 1007h",
    says: "1005h makes the device a SYNC producer, but 1006h (communication cycle period) is missing",
    help: "add {missing}, or clear bit 30 of 1005h",
    also: &[WINDOW],
    check: Check::Device(check),
    ..Rule::of("W0649")
};

/// Sentence for a window that is longer than the period.
const WINDOW: Form = Form {
    says: "1007h (synchronous window length) is {window} µs, but the period (1006h) is {period} µs",
    help: "write at most {period}, or 0 for no window",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let value = |index| start_number(description, Address::new(index, 0));
    let at = |number: &Spanned<u64>, index| W0649.at(number.span).about(Address::new(index, 0));
    let produces = value(0x1005).filter(|number| number.value & 1 << 30 != 0);
    if let Some(number) = produces.filter(|_| !description.objects.contains_key(&0x1006)) {
        let missing = Fact::Section(0x1006, None);
        findings.push(at(&number, 0x1005).fact("missing", missing));
    }
    if let Some((window, period)) = value(0x1007).zip(value(0x1006))
        && (1..window.value).contains(&period.value)
    {
        let finding = at(&window, 0x1007)
            .form(&WINDOW)
            .fact("window", window.value);
        let finding = finding.fact("period", period.value);
        findings.push(finding.related(period.span, "period set here"));
    }
}
