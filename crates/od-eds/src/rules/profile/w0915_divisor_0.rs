use alloc::vec::Vec;

use crate::description::Value;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::device;
use crate::subject::{Entry, start_number, start_value};
use od_model::Address;

pub(crate) static W0915: Rule = Rule {
    title: "value that scales is 0",
    why: "A device that follows the profile aborts a download of 0, and a master that scales positions divides by it. With a factor of 0 each scaled value is the same.",
    source: "CiA 401, objects 642Fh to 6447h; CiA 402, objects 608Fh to 6092h; CiA 404, object 6126h; CiA 406, objects 6001h and 6501h",
    says: "{object} is 0, but positions are divided by it",
    help: "write the number of increments or revolutions, 1 or more{fix}",
    also: &[FACTOR],
    fixability: Fixability::Unsafe,
    check: Check::Entry(check),
    ..Rule::of("W0915")
};

/// Sentence for a factor.
const FACTOR: Form = Form {
    says: "{object} is 0, but it is the factor of each value of the channel",
    help: "write the factor; 1 changes no value{fix}",
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let profile = match (entry.address.index, entry.address.sub) {
        (0x642F | 0x6432 | 0x6442 | 0x6447, 1..=254) => return factor(entry, 401, findings),
        (0x6126, 1..=254) => return factor(entry, 404, findings),
        (0x608F..=0x6092, 1 | 2) => 402,
        (0x6001 | 0x6002 | 0x6501, 0) => 406,
        _ => return,
    };
    let number = start_number(entry.description, entry.address);
    if let Some(number) = number.filter(|number| number.value == 0)
        && device(entry.description, profile).is_some()
        && (entry.address.index != 0x6002 || scales(entry))
    {
        let finding = W0915.on(entry, number.span).fact("object", entry.shown());
        // Most drives count for one revolution.
        let is_divisor = profile == 402 && entry.address.sub == 2;
        findings.push(if is_divisor {
            finding.fix(Fix::unsafe_fix().replace(number.span, "1"))
        } else {
            finding
        });
    }
}

fn factor(entry: &Entry<'_>, profile: u16, findings: &mut Vec<Finding>) {
    let value = start_value(entry.entry);
    let is_0 = |value: &Value| matches!(value, Value::Real(0.0)) || value.integer(0) == Some(0);
    if let Some(value) = value.filter(|value| is_0(value))
        && device(entry.description, profile).is_some()
    {
        let finding = W0915.on(entry, value.span).form(&FACTOR);
        let fix = Fix::unsafe_fix().replace(value.span, "1");
        findings.push(finding.fact("object", entry.shown()).fix(fix));
    }
}

/// Returns whether the encoder scales its position by 6002h, as bit 2 of 6000h says. A range of 0
/// means 2^32 units in an encoder with this number of units.
fn scales(entry: &Entry<'_>) -> bool {
    let number = |index| {
        let number = start_number(entry.description, Address::new(index, 0));
        number.map_or(0, |number| number.value)
    };
    let units = number(0x6501).saturating_mul(number(0x6502).max(1));
    number(0x6000) & 4 != 0 && units < 1 << 32
}
