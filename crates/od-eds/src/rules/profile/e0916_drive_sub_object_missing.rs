use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::profile::shared::device;
use crate::subject::Object;
use od_model::Address;

pub(crate) static E0916: Rule = Rule {
    code: "E0916",
    severity: Error,
    buildable: true,
    title: "drive object lacks a sub-object",
    why: "A master that knows the object from the profile reads or writes the sub-object and gets an abort.",
    source: "CiA 402, objects 607Bh, 607Dh, 608Fh to 6092h, 6099h and 60C2h",
    says: "{object} lacks sub-index {sub}",
    help: "add {missing}",
    check: Check::Object(check),
    ..Rule::NEW
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let own = &object.object.entries;
    let is_pair = matches!(
        object.index,
        0x607B | 0x607D | 0x608F..=0x6092 | 0x6099 | 0x60C2
    );
    // Other rules are about an object without any sub-object.
    if !is_pair || own.is_empty() || !object.code.has_members() {
        return;
    }
    let missing = [1, 2].into_iter().filter(|sub| !own.contains_key(sub));
    for sub in missing.filter(|_| device(object.description, 402).is_some()) {
        let finding = E0916
            .on(object, object.span)
            .about(Address::new(object.index, sub));
        let finding = finding.fact("object", Fact::Index(object.index));
        let missing = Fact::Section(object.index, Some(sub));
        findings.push(finding.fact("sub", sub).fact("missing", missing));
    }
}
