use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity::Warning};
use crate::rules::profile::shared::device;
use crate::subject::Object;
use od_model::Address;

pub(crate) static E0916: Rule = Rule {
    buildable: true,
    title: "drive object lacks a sub-object",
    why: "A master that knows the object from the profile reads or writes the sub-object and gets an abort.",
    source: "CiA 402, objects 607Bh, 607Dh, 608Fh to 6092h, 6099h and 60C2h",
    says: "{object} lacks sub-index {sub}",
    help: "add {missing}",
    also: &[MORE],
    check: Check::Object(check),
    ..Rule::of("E0916")
};

/// Sentence for a sub-object that the profile does not have.
const MORE: Form = Form {
    says: "{object} has sub-index {sub}, but CiA 402 ends at 2",
    help: "remove the sub-object, or move it to 2000h to 5FFFh (manufacturer-specific objects)",
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
    if device(object.description, 402).is_none() {
        return;
    }
    if let Some(entry) = object
        .entries()
        .find(|entry| (3..255).contains(&entry.address.sub))
    {
        let finding = E0916.on(&entry, entry.origin()).form(&MORE);
        let finding = finding.fact("object", Fact::Index(object.index));
        let finding = finding.fact("sub", entry.address.sub);
        findings.push(finding.severity_of(Warning));
    }
    let missing = [1, 2].into_iter().filter(|sub| !own.contains_key(sub));
    for sub in missing {
        let finding = E0916
            .on(object, object.span)
            .about(Address::new(object.index, sub));
        let finding = finding.fact("object", Fact::Index(object.index));
        let missing = Fact::Section(object.index, Some(sub));
        findings.push(finding.fact("sub", sub).fact("missing", missing));
    }
}
