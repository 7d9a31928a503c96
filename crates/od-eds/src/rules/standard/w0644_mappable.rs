use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::standards::cia301::of;
use crate::subject::Entry;

pub(crate) static W0644: Rule = Rule {
    title: "standard object is mappable",
    why: "A master may map the object, and the device aborts the mapping. CiA 301 allows a mapping of few of its objects, such as 1001h, 1013h and 1026h.",
    source: "CiA 301, chapter 7.5; CiA 302",
    fixability: Fixability::Unsafe,
    says: "{PDOMapping} of {object} ({name}) is 1, but {standard} does not allow a mapping",
    help: "write `{PDOMapping=0}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0644")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let index = entry.address.index;
    let may = matches!(index, 0x1001..=0x1003 | 0x1013 | 0x1026 | 0x1200..=0x12FF | 0x1F00..);
    if let Some(standard) = of(index).filter(|_| *entry.mappable && !may) {
        let finding = W0644.on(entry, entry.mappable.span);
        let finding = finding
            .fact("object", entry.shown())
            .fact("name", standard.name);
        let fix = Fix::unsafe_fix().replace(entry.mappable.span, "0");
        findings.push(finding.fact("standard", standard.source()).fix(fix));
    }
}
