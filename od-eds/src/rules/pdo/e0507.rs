use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static RULE: Rule = Rule {
    code: "E0507",
    severity: Error,
    title: "TPDO maps a dummy",
    why: "Dummies fill gaps in what is received; there is nothing to send.",
    source: "CiA 301, dummy mapping",
    says: "{dummy} is a dummy, and this is a TPDO",
    help: "map an object that can be sent",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        if mapped.is_dummy() && !mapped.rpdo {
            let dummy = Fact::Index(mapped.target.index);
            findings.push(mapped.finding(&RULE).fact("dummy", dummy));
        }
    }
}
