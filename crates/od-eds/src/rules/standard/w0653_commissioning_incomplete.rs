use alloc::string::ToString;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::standard::shared::commissioning;
use crate::scan::number::number;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0653: Rule = Rule {
    title: "[DeviceComissioning] is incomplete, or contradicts an object",
    why: "A configuration tool does not know which node it configures, or configures another one by LSS.",
    source: "CiA 306-1, DeviceComissioning",
    says: "[{section}] lacks `{field}`",
    help: "add `{field}=` and its value",
    also: &[SERIAL, NO_LSS, MANAGER],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0653")
};

/// Sentence for a serial number that is not the one of 1018h.
const SERIAL: Form = Form {
    says: "LSS_SerialNumber is {given}, but 1018h:04 is {right}",
    help: "write `LSS_SerialNumber={right}`{fix}, or correct 1018h:04",
};

/// Sentence for a serial number of a device without LSS.
const NO_LSS: Form = Form {
    says: "LSS_SerialNumber is {given}, but LSS_Supported is 0",
    help: "write `LSS_Supported=1` in [DeviceInfo], or remove LSS_SerialNumber",
};

/// Sentence for a manager that is not an NMT master.
const MANAGER: Form = Form {
    says: "CANopenManager is 1, but 1F80h (NMT startup) is missing: the device is not an NMT master",
    help: "write `CANopenManager=0`{fix}, or add 1F80h",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(section) = commissioning(description) else {
        return;
    };
    for field in ["NodeID", "Baudrate"] {
        let given = section.get(field);
        if given.is_none_or(|given| given.is_empty()) {
            let place = given.map_or(section.name.span, |given| given.span);
            let finding = W0653.at(place).fact("field", field);
            findings.push(finding.fact("section", section.name.as_str()));
        }
    }
    let address = Address::new(0x1018, 4);
    let given = section
        .get("LSS_SerialNumber")
        .filter(|given| !given.is_empty());
    // 0 is the serial number of a device type.
    let own = start_number(description, address).filter(|own| own.value != 0);
    if let Some((given, own)) = given.zip(own)
        && let Some(serial) = number(given)
        && serial != 0
        && serial != i128::from(own.value)
    {
        let finding = W0653.at(given.span).about(address).form(&SERIAL);
        let finding = finding.fact("given", serial).fact("right", own.value);
        let fix = Fix::unsafe_fix().replace(given.span, own.value.to_string());
        let finding = finding.related(own.span, "serial number set here");
        findings.push(finding.fix(fix));
    }
    let info = description.section("DeviceInfo");
    let lss = info.and_then(|info| info.get("LSS_Supported"));
    if let Some((given, lss)) = given.zip(lss)
        && let Some(serial @ 1..) = number(given)
        && number(lss) == Some(0)
    {
        let finding = W0653.at(given.span).form(&NO_LSS).fact("given", serial);
        findings.push(finding.related(lss.span, "no LSS"));
    }
    if let Some(given) = section.get("CANopenManager")
        && number(given) == Some(1)
        && !description.objects.contains_key(&0x1F80)
    {
        let fix = Fix::unsafe_fix().replace(given.span, "0");
        findings.push(W0653.at(given.span).form(&MANAGER).fix(fix));
    }
}
