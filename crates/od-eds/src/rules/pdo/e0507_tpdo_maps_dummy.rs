use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static E0507: Rule = Rule {
    title: "TPDO maps a dummy entry",
    why: "Dummy entries skip bits of a received PDO. A TPDO has no value to send for them.",
    source: "CiA 301, dummy mapping",
    says: "{dummy} is a dummy entry and cannot be mapped into a TPDO",
    help: "map an object that the device can send",
    check: Check::Object(check),
    ..Rule::of("E0507")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        if mapped.is_dummy() && !mapped.rpdo {
            let dummy = Fact::Index(mapped.target.index);
            findings.push(mapped.finding(&E0507).fact("dummy", dummy));
        }
    }
}
