use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::subject::Object;

pub(crate) static W0508: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "PDO has only one of its two objects",
    why: "A PDO needs a communication parameter and a mapping parameter, whose indices differ by 200h.",
    source: "CiA 301, PDO communication parameter",
    says: "{object} has no {what} parameter {other}",
    help: "add {missing}",
    check: Check::Object(check),
    ..Rule::of("W0508")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let (other, what) = match object.index {
        0x1400..=0x15FF | 0x1800..=0x19FF => (object.index + 0x200, "mapping"),
        0x1600..=0x17FF | 0x1A00..=0x1BFF => (object.index - 0x200, "communication"),
        _ => return,
    };
    if !object.description.objects.contains_key(&other) {
        let finding = W0508
            .on(object, object.span)
            .fact("object", Fact::Index(object.index));
        let finding = finding.fact("what", what).fact("other", Fact::Index(other));
        findings.push(finding.fact("missing", Fact::Section(other, None)));
    }
}
