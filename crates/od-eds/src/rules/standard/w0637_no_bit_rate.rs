use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::rules::lists::reader::is_rate;
use crate::scan::number::number;

pub(crate) static W0637: Rule = Rule {
    title: "device supports no bit rate",
    why: "A tool that offers the bit rates of all devices on the bus offers none.",
    source: "CiA 306-1, DeviceInfo",
    says: "[DeviceInfo] sets every bit rate to 0",
    help: "write 1 for each supported bit rate, such as `BaudRate_125=1`",
    check: Check::Device(check),
    ..Rule::of("W0637")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("DeviceInfo") else {
        return;
    };
    let mut rates = info.pairs.iter().filter(|(key, _)| is_rate(key)).peekable();
    let Some((_, first)) = rates.peek() else {
        return;
    };
    if rates.all(|(_, rate)| number(rate) == Some(0)) && !description.objects.is_empty() {
        findings.push(W0637.at(first.span));
    }
}
