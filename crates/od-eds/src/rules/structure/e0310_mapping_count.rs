use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::rules::structure::shared::Count;
use crate::subject::Object;

pub(crate) static E0310: Rule = Rule {
    title: "PDO mapping counts entries that do not exist",
    why: "A node cannot build a PDO from mapping entries that do not exist. In a macro call the rule covers every object. Sub-index 0 of a mapping may be lower than the highest sub-index, never higher.",
    source: "CiA 301, object structure",
    fixability: Fixability::Unsafe,
    says: "sub-index 0 is {given}, but the highest sub-index is {highest}",
    help: "write `{DefaultValue={highest}}`{fix}",
    check: Check::Object(check),
    ..Rule::of("E0310")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let count = Count::of(object).filter(|count| count.is_too_high() && count.is_error());
    findings.extend(count.map(|count| count.finding(&E0310)));
}
