use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::subject::Object;

pub(crate) static I0345: Rule = Rule {
    title: "two sub-objects have the same name",
    why: "A master that finds values by name finds only one of them.",
    source: "odkit; python-canopen and others look up by name",
    says: "two sub-objects have the name `{name}`",
    help: "write another name",
    check: Check::Object(check),
    ..Rule::of("I0345")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    // Tools identify sub-objects of the standards by their number.
    if !object.code.has_members() || matches!(object.index, 0x1000..=0x1FFF) {
        return;
    }
    let mut names = BTreeMap::new();
    for entry in object.entries().filter(|entry| !entry.name.is_empty()) {
        let (name, span) = (entry.entry.name.value.as_str(), entry.name.span);
        // All sub-objects of a CompactSubObj have one name and one place.
        if let Some(first) = names.insert(name, span)
            && first != span
        {
            let finding = I0345.on(&entry, span).fact("name", name);
            findings.push(finding.related(first, "first used here"));
        }
    }
}
