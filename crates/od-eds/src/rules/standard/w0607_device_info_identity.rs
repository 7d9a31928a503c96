use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::scan::number::number;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0607: Rule = Rule {
    title: "identity differs from [DeviceInfo]",
    why: "A tool that picks the EDS by vendor, product and revision finds no match. [DeviceInfo] repeats the default values of 1018h.",
    source: "CiA 306-1, DeviceInfo",
    fixability: Fixability::Unsafe,
    says: "{field} is 0x{given:X}, but {object} is 0x{value:X}",
    help: "write `{field}=0x{value:X}`{fix}, or correct {object}",
    check: Check::Device(check),
    ..Rule::of("W0607")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("DeviceInfo") else {
        return;
    };
    for (field, sub) in [
        ("VendorNumber", 1),
        ("ProductNumber", 2),
        ("RevisionNumber", 3),
    ] {
        let address = Address::new(0x1018, sub);
        let object = start_number(description, address);
        let default = description
            .entry(address)
            .and_then(|entry| entry.default.as_ref());
        let default = default.and_then(|default| default.integer(0));
        let (Some(given), Some(object)) = (info.get(field), object) else {
            continue;
        };
        // 0 means that the value is not known; W0609 reports a value that is not a number of 32 bits.
        let known = number(given).and_then(|number| u32::try_from(number).ok());
        // A DCF with the identity of another device has a finding of its own.
        let differs = |given: &u32| {
            let is_default = default == Some(i128::from(*given));
            *given != 0 && u64::from(*given) != object.value && !is_default
        };
        let Some(number) = known.filter(|given| object.value != 0 && differs(given)) else {
            continue;
        };
        let fix = Fix::unsafe_fix().replace(given.span, format!("0x{:X}", object.value));
        let finding = W0607.at(given.span).about(address).fact("field", field);
        let finding = finding.fact("given", number).fact("object", address);
        let finding = finding.fact("value", object.value).fix(fix);
        findings.push(finding.related(object.span, "{object} is set here"));
    }
}
