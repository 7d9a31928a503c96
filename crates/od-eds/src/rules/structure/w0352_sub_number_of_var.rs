use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::Object;

pub(crate) static W0352: Rule = Rule {
    title: "SubNumber of an object without sub-objects",
    why: "A tool that trusts SubNumber reads sub-objects that do not exist. Only an ARRAY or a RECORD has sub-objects to count.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{SubNumber} is {given}, but {code} has no sub-objects",
    help: "remove {SubNumber}{fix}",
    check: Check::Object(check),
    ..Rule::of("W0352")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let given = object.sub_number.filter(|given| given.value > 1);
    if let Some(given) = given.filter(|_| !object.code.has_members()) {
        let finding = W0352.on(object, given.span).fact("given", given.value);
        let finding = finding.fact("code", *object.code);
        findings.push(finding.fix(Fix::unsafe_fix().remove_line(given.span)));
    }
}
