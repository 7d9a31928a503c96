use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule};
use crate::subject::{Entry, objects};
use od_model::Access;

pub(crate) static I0447: Rule = Rule {
    title: "AccessType `rw` gives no PDO direction",
    why: "A mappable `rw` object can be mapped into TPDOs and RPDOs; `rwr` or `rww` limits it to one of them. odkit reports the first one and counts the others.",
    source: "CiA 306-1, AccessType",
    says: "{AccessType} `rw` of {count:mappable value|mappable values} gives no PDO direction",
    help: "write `{AccessType=rwr}` for TPDOs only, or `{AccessType=rww}` for RPDOs only",
    check: Check::Device(check),
    ..Rule::of("I0447")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let mut count = 0_usize;
    let mut first = None;
    for object in objects(description) {
        for entry in object.entries().filter(is_one) {
            count += 1;
            first.get_or_insert_with(|| I0447.on(&entry, entry.access.span));
        }
    }
    findings.extend(first.map(|first| first.fact("count", count)));
}

fn is_one(entry: &Entry<'_>) -> bool {
    let data_type = entry.data_type;
    let fixed = data_type.is_some_and(|data_type| data_type.bits().is_some());
    *entry.mappable && fixed && *entry.access == Access::Rw
}
