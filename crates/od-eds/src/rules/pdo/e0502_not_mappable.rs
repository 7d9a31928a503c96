use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static E0502: Rule = Rule {
    title: "PDO maps an object that is not mappable",
    why: "A device aborts the download of a mapping entry whose object has PDOMapping 0.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    says: "{object} \"{name}\" is not mappable",
    help: "write `{PDOMapping=1}` for {object}{fix}, or map another object",
    check: Check::Object(check),
    ..Rule::of("E0502")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        let Some(value) = mapped.value().filter(|value| !*value.mappable) else {
            continue;
        };
        let fix = Fix::unsafe_fix().replace(value.mappable.span, "1");
        let finding = mapped.finding(&E0502).fact("object", value.shown());
        let finding = finding.fact("name", value.name.as_str()).fix(fix);
        findings.push(finding.related(value.mappable.span.or(value.span), "object defined here"));
    }
}
