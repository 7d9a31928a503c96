use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::subject::Object;

pub(crate) static W0343: Rule = Rule {
    title: "index is reserved",
    why: "A tool may reject the object, and a later standard may use its index. Objects of a device are at 1000h to 9FFFh, data types below 0260h, network and system variables at A000h to BFFFh.",
    source: "CiA 301, object dictionary structure",
    says: "{index} is a reserved index",
    help: "move the object to 2000h to 5FFFh (manufacturer-specific objects)",
    check: Check::Object(check),
    ..Rule::of("W0343")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if matches!(object.index, 0 | 0x0260..=0x0FFF | 0xC000..) {
        let index = Fact::Index(object.index);
        findings.push(W0343.on(object, object.span).fact("index", index));
    }
}
