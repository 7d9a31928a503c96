use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity::Warning};
use crate::scan::number::number;

pub(crate) static RULE: Rule = Rule {
    code: "W0638",
    severity: Warning,
    title: "node ID or bit rate of a DCF is not valid",
    why: "A configuration tool cannot set the node ID or the bit rate. A node ID is 1 to 127, and CiA 301 defines the bit rates.",
    source: "CiA 306-1, DeviceComissioning",
    says: "{field} `{given}` is not valid",
    help: "write 1 to 127, or 255 for a node that gets its node ID by LSS",
    also: &[RATE],
    check: Check::Device(check),
    ..Rule::NEW
};

/// Sentence for a bit rate.
const RATE: Form = Form {
    help: "write 10, 20, 50, 125, 250, 500, 800 or 1000 (kbit/s)",
    ..Form::OWN
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let section = description.section("DeviceComissioning");
    let section = section.or_else(|| description.section("DeviceCommissioning"));
    let mut report = |field, is_wrong: fn(i128) -> bool, form: Option<&Form>| {
        let given = section.and_then(|section| section.get(field));
        let Some(given) = given.filter(|given| number(given).is_some_and(is_wrong)) else {
            return;
        };
        let finding = RULE
            .at(given.span)
            .fact("field", field)
            .fact("given", given.as_str());
        findings.push(match form {
            Some(form) => finding.form(form),
            None => finding,
        });
    };
    // The reader reports what is not a number.
    report("NodeID", |id| matches!(id, 0 | 128..=254), None);
    let is_wrong = |rate| {
        let valid = matches!(rate, 10 | 20 | 50 | 100 | 125 | 250 | 500 | 800 | 1000);
        (0..=0xFFFF).contains(&rate) && !valid
    };
    report("Baudrate", is_wrong, Some(&RATE));
}
