use alloc::string::ToString;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::rules::pdo::shared::numbers;
use crate::subject::{Object, start_number};
use od_model::Address;

pub(crate) static W0525: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "mapping entry in use is 0",
    why: "Sub-index 0 is the number of mapped objects, and each of these entries names one. A device aborts such a mapping.",
    source: "CiA 301, PDO mapping parameter",
    says: "mapping entry is 0, but sub-index 0 counts it as mapped",
    help: "write the mapped object, such as `0x60040020`, or lower sub-index 0{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Object(check),
    ..Rule::of("W0525")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let entries: Vec<_> = numbers(object).collect();
    let used = entries.iter().rposition(|(_, number)| number.value != 0);
    let used = used.map_or(0, |last| last + 1);
    let count = start_number(object.description, Address::new(object.index, 0));
    for (at, (entry, number)) in entries.iter().enumerate() {
        // The entry is 0, even its length, so no other part needs a check.
        if number.value == 0 {
            let finding = W0525.on(entry, number.span);
            let last = count.as_ref().filter(|_| at == used);
            findings.push(match last {
                Some(count) => finding.fix(Fix::unsafe_fix().replace(count.span, used.to_string())),
                None => finding,
            });
        }
    }
}
