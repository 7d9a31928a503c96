use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::mapped;
use crate::subject::Object;

pub(crate) static E0512: Rule = Rule {
    title: "PDO maps a sub-index that does not exist",
    why: "A device cannot build the PDO, and a master cannot decode it.",
    source: "CiA 301, PDO mapping parameter",
    says: "mapped sub-object {sub} does not exist",
    help: "map a sub-object that exists, or add {sub}",
    check: Check::Object(check),
    ..Rule::of("E0512")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    for mapped in mapped(object) {
        let object = object.description.objects.get(&mapped.target.index);
        let Some(object) = object.filter(|_| mapped.value().is_none() && !mapped.is_dummy()) else {
            continue;
        };
        let finding = mapped.finding(&E0512).fact("sub", mapped.target);
        let finding = finding.fact("object", Fact::Index(mapped.target.index));
        findings.push(finding.related(object.span, "{object} defined here"));
    }
}
