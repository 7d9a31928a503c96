use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::Object;
use od_model::{Kind, ObjectCode};

pub(crate) static W0427: Rule = Rule {
    title: "DOMAIN has the type of a number",
    why: "One tool transfers the content as a DOMAIN of any length, another as a number. odkit uses the DataType.",
    source: "CiA 301, object codes; CiA 306-1, object sections",
    fixability: Fixability::Unsafe,
    says: "{ObjectType} is DOMAIN, but {DataType} is {given}",
    help: "write `{DataType=0x000F}` (DOMAIN){fix}, or `{ObjectType=0x7}` (VAR)",
    check: Check::Object(check),
    ..Rule::of("W0427")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if *object.code != ObjectCode::Domain {
        return;
    }
    for entry in object.entries() {
        let number = |kind| !matches!(kind, Kind::Text | Kind::Bytes | Kind::Record);
        if let Some(given) = entry.data_type.filter(|given| number(given.kind())) {
            let finding = W0427.on(&entry, given.span).fact("given", *given);
            let finding = finding.related(object.code.span, "declared as DOMAIN here");
            findings.push(finding.fix(Fix::unsafe_fix().replace(given.span, "0x000F")));
        }
    }
}
