use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule};
use crate::subject::objects;

pub(crate) static I0346: Rule = Rule {
    title: "two objects have the same name",
    why: "A master that finds objects by name finds only one of them.",
    source: "odkit; python-canopen and others look up by name",
    says: "{first} and {index} have the same name `{name}`",
    help: "write another name for one of them",
    check: Check::Device(check),
    ..Rule::of("I0346")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let mut names = BTreeMap::new();
    // Tools identify objects of the standards by their index.
    let own = objects(description).filter(|object| !matches!(object.index, 0x1000..=0x1FFF));
    for object in own.filter(|object| !object.name.is_empty()) {
        let (name, span) = (object.object.name.value.as_str(), object.name.span);
        let (first, place) = *names.entry(name).or_insert((object.index, span));
        if first != object.index {
            let finding = I0346.on(&object, span).fact("first", Fact::Index(first));
            let finding = finding.fact("index", Fact::Index(object.index));
            findings.push(finding.fact("name", name).related(place, "first used here"));
        }
    }
}
