use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0536: Rule = Rule {
    title: "SYNC start value without a SYNC counter",
    why: "The device ignores the start value: SYNC messages have a counter only if 1019h is not 0.",
    source: "CiA 301, PDO communication parameter and object 1019h",
    says: "SYNC start value is {given}, but object 1019h is missing",
    help: "add {missing}, or write 0{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Object(check),
    ..Rule::of("W0536")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let counts = object.description.objects.contains_key(&0x1019);
    if counts || !matches!(object.index, 0x1800..=0x19FF) {
        return;
    }
    let address = Address::new(object.index, 6);
    let given = start_number(object.description, address);
    if let Some(given) = given.filter(|given| given.value != 0) {
        let finding = W0536.on(object, given.span).about(address);
        let finding = finding.fact("given", given.value);
        let finding = finding.fact("missing", Fact::Section(0x1019, None));
        findings.push(finding.fix(Fix::unsafe_fix().replace(given.span, "0")));
    }
}
