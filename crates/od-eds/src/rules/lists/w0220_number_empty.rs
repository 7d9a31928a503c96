use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::scan::forms::{self, Form};

pub(crate) static W0220: Rule = Rule {
    title: "number of [DeviceInfo] is empty",
    why: "A reader that makes a number of the text stops: python-canopen rejects the whole file. odkit assumes 0.",
    source: "CiA 306-1, DeviceInfo",
    fixability: Fixability::Safe,
    says: "{name} in [DeviceInfo] is empty",
    help: "write `{name}=0`{fix}, or the value of the device",
    check: Check::Device(check),
    ..Rule::of("W0220")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("DeviceInfo") else {
        return;
    };
    let Some((_, known)) = forms::section("DeviceInfo") else {
        return;
    };
    for (key, value) in info.pairs.iter().filter(|(_, value)| value.is_empty()) {
        let Some((name, form)) = forms::key(known, key) else {
            continue;
        };
        if matches!(form, Form::Flag | Form::Number(_)) {
            let finding = W0220.at(value.span).fact("name", name);
            findings.push(finding.fix(Fix::safe().replace(value.span, "0")));
        }
    }
}
