use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static E0501: Rule = Rule {
    title: "PDO maps an object that does not exist",
    why: "A device cannot build the PDO, and a master cannot decode it.",
    source: "CiA 301, PDO mapping parameter",
    says: "mapped object {object} does not exist",
    help: "map an object that exists, or add {object}",
    check: Check::Object(check),
    ..Rule::of("E0501")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        let index = mapped.target.index;
        if !mapped.is_dummy() && !object.description.objects.contains_key(&index) {
            findings.push(mapped.finding(&E0501).fact("object", Fact::Index(index)));
        }
    }
}
