use alloc::format;
use alloc::string::ToString;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::rules::structure::shared::counts;
use crate::subject::Object;

pub(crate) static RULE: Rule = Rule {
    code: "W0308",
    severity: Warning,
    title: "SubNumber does not match the sub-objects",
    why: "A tool that trusts SubNumber misses sub-objects, or fails where one is missing. SubNumber counts the sub-index sections, sub-index 0 included; odkit counts them itself.",
    source: "CiA 306-1, object sections",
    fixability: Fixability::Safe,
    says: "{SubNumber} is {given}, but the object has {count:sub-index|sub-indices}",
    help: "write `{SubNumber={count}}`{fix}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let count = object.object.entries.len();
    let given = object
        .sub_number
        .filter(|given| given.value as usize != count);
    if let Some(given) = given.filter(|_| counts(object)) {
        let finding = RULE.on(object, given.span).fact("given", given.value);
        let finding = finding.fact("count", count);
        // A section that is about the object, but no sub-object: probably one with a wrong name.
        let start = format!("{:04X}", object.index);
        let lost = object.description.sections.iter().any(|section| {
            let own = section.name.get(..4);
            own.is_some_and(|own| own.eq_ignore_ascii_case(&start))
        });
        findings.push(match lost {
            true => finding,
            false => finding.fix(Fix::safe().replace(given.span, count.to_string())),
        });
    }
}
