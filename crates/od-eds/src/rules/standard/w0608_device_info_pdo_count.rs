use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;

pub(crate) static W0608: Rule = Rule {
    title: "number of PDOs differs from [DeviceInfo]",
    why: "A tool that trusts NrOfRxPDO and NrOfTxPDO misses PDOs, or looks for PDOs that do not exist.",
    source: "CiA 306-1, DeviceInfo",
    fixability: Fixability::Safe,
    says: "{field} is {given}, but the file defines {count:TPDO|TPDOs} (1800h–19FFh)",
    help: "write `{field}={count}`{fix}",
    also: &[RPDOS],
    check: Check::Device(check),
    ..Rule::of("W0608")
};

/// Sentence for RPDOs.
const RPDOS: Form = Form {
    says: "{field} is {given}, but the file defines {count:RPDO|RPDOs} (1400h–15FFh)",
    ..Form::OWN
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("DeviceInfo") else {
        return;
    };
    for (field, range, form) in [
        ("NrOfRxPDO", 0x1400..=0x15FF, Some(&RPDOS)),
        ("NrOfTxPDO", 0x1800..=0x19FF, None),
    ] {
        let Some(given) = info.get(field) else {
            continue;
        };
        let count = description.objects.range(range).count();
        if let Some(number) = number(given).filter(|number| *number != count as i128) {
            let finding = W0608
                .at(given.span)
                .fact("field", field)
                .fact("given", number);
            let fix = Fix::safe().replace(given.span, format!("{count}"));
            let finding = finding.fact("count", count).fix(fix);
            findings.push(match form {
                Some(form) => finding.form(form),
                None => finding,
            });
        }
    }
}
