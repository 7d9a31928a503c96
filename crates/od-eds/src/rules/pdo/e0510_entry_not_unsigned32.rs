use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::maps_rpdo;
use crate::subject::Object;
use od_model::DataType;

pub(crate) static E0510: Rule = Rule {
    title: "mapping entry is not an UNSIGNED32",
    why: "A mapping entry holds index, sub-index and length in one UNSIGNED32. A master that writes it as four bytes gets an SDO abort.",
    source: "CiA 301, PDO mapping parameter",
    fixability: Fixability::Unsafe,
    says: "mapping entry is {given} but must be {right}",
    help: "write `{DataType={right}}`{fix}",
    check: Check::Object(check),
    ..Rule::of("E0510")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if maps_rpdo(object.index).is_none() || !object.code.has_members() {
        return;
    }
    // A master can write an entry that is not used, too.
    for entry in object.entries().filter(|entry| entry.address.sub != 0) {
        if let Some(given) = entry
            .data_type
            .filter(|given| **given != DataType::Unsigned32)
        {
            let fix = Fix::unsafe_fix().replace(given.span, "0x0007");
            let finding = E0510.on(&entry, given.span).fact("given", *given);
            findings.push(finding.fact("right", DataType::Unsigned32).fix(fix));
        }
    }
}
