use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::standards::cia301::of;
use crate::subject::Object;

pub(crate) static RULE: Rule = Rule {
    code: "W0642",
    severity: Warning,
    title: "object needs another object that is missing",
    why: "A master that finds one half of a service expects the other half, and cannot use the service.",
    source: "CiA 301, objects 1005h to 1029h",
    says: "{object} needs object {other} ({name}), which is missing",
    help: "add {missing}, or remove {object}",
    check: Check::Object(check),
    ..Rule::NEW
};

/// Objects, each with the one that it needs.
const PAIRS: [(u16, u16); 10] = [
    (0x1006, 0x1005),
    (0x1007, 0x1005),
    (0x1019, 0x1005),
    (0x100C, 0x100D),
    (0x100D, 0x100C),
    (0x1010, 0x1011),
    (0x1011, 0x1010),
    (0x1015, 0x1014),
    (0x1022, 0x1021),
    (0x1024, 0x1023),
];

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let pair = PAIRS.iter().find(|(index, _)| *index == object.index);
    if let Some((index, other)) = pair
        && !object.description.objects.contains_key(other)
    {
        let finding = RULE.on(object, object.span);
        let finding = finding.fact("object", Fact::Index(*index));
        let name = of(*other).map_or("", |standard| standard.name);
        let finding = finding
            .fact("other", Fact::Index(*other))
            .fact("name", name);
        findings.push(finding.fact("missing", Fact::Section(*other, None)));
    }
}
