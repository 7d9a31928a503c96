use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::structure::shared::sub_index_0;
use crate::subject::Object;
use od_model::DataType;

pub(crate) static E0309: Rule = Rule {
    title: "sub-index 0 is not UNSIGNED8",
    why: "A master reads sub-index 0 of every ARRAY and RECORD as one byte, the highest sub-index.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    says: "sub-index 0 is {given}, not {right}",
    help: "write `{DataType={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::of("E0309")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let Some(entry) = sub_index_0(object) else {
        return;
    };
    if let Some(given) = entry
        .data_type
        .filter(|given| **given != DataType::Unsigned8)
    {
        let finding = E0309.on(&entry, given.span).fact("given", *given);
        let finding = finding.fact("right", DataType::Unsigned8);
        findings.push(finding.fix(Fix::unsafe_fix().replace(given.span, "0x0005")));
    }
}
