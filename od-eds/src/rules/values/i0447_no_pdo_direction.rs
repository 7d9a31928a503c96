use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Info};
use crate::subject::Entry;
use od_model::Access;

pub(crate) static RULE: Rule = Rule {
    code: "I0447",
    severity: Info,
    title: "AccessType `rw` gives no PDO direction",
    why: "A mappable `rw` object can be mapped into TPDOs and RPDOs; `rwr` or `rww` limits it to one of them.",
    source: "CiA 306-1, AccessType",
    says: "{AccessType} `rw` of a mappable object gives no PDO direction",
    help: "write `{AccessType=rwr}` for TPDOs only, or `{AccessType=rww}` for RPDOs only",
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
