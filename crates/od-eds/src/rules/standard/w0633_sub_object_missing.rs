use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::standards::cia301::{Members, has_node_ids, of};
use crate::subject::Object;
use od_model::Address;

pub(crate) static W0633: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "standard object lacks a sub-object",
    why: "A master that knows the object from the standard reads the sub-object and gets an abort.",
    source: "CiA 301, chapter 7.5; CiA 302",
    says: "{object} ({name}) lacks sub-index {sub}",
    help: "add {missing}",
    check: Check::Object(check),
    ..Rule::of("W0633")
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    // Other rules are about objects without sub-objects, 1018h and the PDOs.
    let own_rule = matches!(object.index, 0x1018 | 0x1400..=0x1BFF);
    let own = &object.object.entries;
    let Some(standard) = of(object.index).filter(|found| found.is_like(*object.code)) else {
        return;
    };
    let subs: Vec<u8> = match &standard.members {
        Members::Var(_) => return,
        // Date and time of the configuration.
        Members::Array(_) if object.index == 0x1020 => [1, 2].into(),
        Members::Array(_) if has_node_ids(object.index) => return,
        Members::Array(_) => [1].into(),
        Members::Record(members) => {
            let mandatory = members.iter().filter(|(_, _, mandatory)| *mandatory);
            mandatory.map(|(sub, _, _)| *sub).collect()
        }
    };
    if own.is_empty() || own_rule {
        return;
    }
    for sub in subs.into_iter().filter(|sub| !own.contains_key(sub)) {
        let finding = W0633
            .on(object, object.span)
            .about(Address::new(object.index, sub));
        let finding = finding
            .fact("object", Fact::Index(object.index))
            .fact("name", standard.name);
        let missing = Fact::Section(object.index, Some(sub));
        findings.push(finding.fact("sub", sub).fact("missing", missing));
    }
}
