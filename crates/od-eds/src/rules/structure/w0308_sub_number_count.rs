use alloc::string::ToString;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::structure::shared::{counts, has_lost};
use crate::subject::Object;

pub(crate) static W0308: Rule = Rule {
    title: "SubNumber does not match the sub-objects",
    why: "A tool that trusts SubNumber misses sub-objects, or fails where one is missing. SubNumber counts the sub-index sections, sub-index 0 included; odkit counts them itself.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "{SubNumber} is {given}, but the object has {count:sub-index|sub-indices}",
    help: "write `{SubNumber={count}}`{fix}",
    check: Check::Object(check),
    ..Rule::of("W0308")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let count = object.object.entries.len();
    let given = object
        .sub_number
        .filter(|given| given.value as usize != count);
    if let Some(given) = given.filter(|_| counts(object)) {
        let finding = W0308.on(object, given.span).fact("given", given.value);
        let finding = finding.fact("count", count);
        findings.push(if has_lost(object.description, object.index) {
            finding
        } else {
            finding.fix(Fix::safe().replace(given.span, count.to_string()))
        });
    }
}
