use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::pdo::shared::{count, maps_rpdo};
use crate::subject::Object;

pub(crate) static W0524: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "mapping counts more than 64 objects",
    why: "A PDO has 64 bits, so it maps at most 64 objects. 254 and 255 mark a multiplexed PDO.",
    source: "CiA 301, PDO mapping parameter",
    says: "{count} objects cannot be mapped into 64 bits",
    help: "write a number up to 64, or 254 or 255 for a multiplexed PDO",
    check: Check::Object(check),
    ..Rule::of("W0524")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let is_mapping = maps_rpdo(object.index).is_some() && object.code.has_members();
    if let (true, Err(given)) = (is_mapping, count(object)) {
        findings.push(W0524.on(object, given.span).fact("count", given.value));
    }
}
