use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Info};
use crate::subject::Entry;
use od_model::Access;

pub(crate) static RULE: Rule = Rule {
    code: "I0447",
    severity: Info,
    title: "mappable, but into which PDO",
    why: "An object that is rw and mappable may stand in TPDOs and RPDOs alike; rwr or rww says which, if it is only one.",
    source: "CiA 306-1, AccessType",
    says: "it is mappable, and `rw` does not say into which PDOs",
    help: "write `rwr` for TPDOs or `rww` for RPDOs, if it is for one of them",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let fixed = entry
        .data_type
        .is_some_and(|data_type| data_type.bits().is_some());
    if *entry.mappable && fixed && *entry.access == Access::Rw {
        findings.push(RULE.on(entry, entry.access.span));
    }
}
