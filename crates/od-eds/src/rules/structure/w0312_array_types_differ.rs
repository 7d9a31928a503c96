use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::is_profile_array;
use crate::standards::cia301::is_standard_array;
use crate::subject::Object;
use od_model::ObjectCode;

pub(crate) static W0312: Rule = Rule {
    title: "sub-objects of an ARRAY differ in type",
    why: "A master that reads all sub-objects of an ARRAY with one type reads some of them wrong. Those of a RECORD may differ.",
    source: "CiA 301, object codes",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but {first} of the same ARRAY is {right}",
    help: "write `{ObjectType=0x9}` (RECORD) if the types are correct{fix}",
    also: &[PRESCRIBED],
    check: Check::Object(check),
    ..Rule::of("W0312")
};

/// The help for an object that is an ARRAY by the standard.
const PRESCRIBED: Form = Form {
    help: "write the same {DataType} for every sub-object; the standard specifies an ARRAY",
    ..Form::OWN
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if *object.code != ObjectCode::Array {
        return;
    }
    let typed = object
        .entries()
        .filter_map(|entry| Some((entry.data_type?, entry)));
    let mut typed = typed.filter(|(_, entry)| (1..=254).contains(&entry.address.sub));
    let Some((right, first)) = typed.next() else {
        return;
    };
    if let Some((given, entry)) = typed.find(|(given, _)| *given != right) {
        let finding = W0312.on(&entry, given.span).fact("object", entry.shown());
        let finding = finding.fact("given", *given).fact("first", first.shown());
        let finding = finding.fact("right", *right);
        let finding = finding.related(right.span, "declared as {right} here");
        let finding = finding.related(object.code.span, "declared as ARRAY here");
        let prescribed = is_standard_array(object.index) || is_profile_array(object);
        findings.push(if prescribed {
            finding.form(&PRESCRIBED)
        } else {
            finding.fix(Fix::unsafe_fix().replace(object.code.span, "0x9"))
        });
    }
}
