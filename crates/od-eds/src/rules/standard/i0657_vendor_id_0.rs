use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::subject::{Entry, start_number};

pub(crate) static I0657: Rule = Rule {
    title: "vendor-ID is 0",
    why: "CiA 301 says that 0 is not a valid vendor-ID: a master cannot tell the device from others, and LSS cannot address it.",
    source: "CiA 301, object 1018h",
    says: "vendor-ID is 0, which is not valid",
    help: "write the vendor-ID that CiA assigned",
    check: Check::Entry(check),
    ..Rule::of("I0657")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if (entry.address.index, entry.address.sub) != (0x1018, 1) {
        return;
    }
    let number = start_number(entry.description, entry.address);
    if let Some(number) = number.filter(|number| number.value == 0) {
        findings.push(I0657.on(entry, number.span));
    }
}
