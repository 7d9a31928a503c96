use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::values::shared::DECLARED;
use crate::subject::Entry;

pub(crate) static W0454: Rule = Rule {
    title: "mappable object has no fixed length",
    why: "A PDO has room only for values of fixed length, not for strings and DOMAINs.",
    source: "CiA 301, data types and PDO mapping parameter",
    fixability: Fixability::Unsafe,
    says: "{type} has no fixed length and cannot be mapped into a PDO",
    help: "write `{PDOMapping=0}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0454")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some(data_type) = entry.data_type.filter(|given| given.bits().is_none())
        && *entry.mappable
    {
        let finding = W0454
            .on(entry, entry.mappable.span)
            .fact("type", *data_type);
        let finding = finding.related(data_type.span, DECLARED);
        findings.push(finding.fix(Fix::unsafe_fix().replace(entry.mappable.span, "0")));
    }
}
