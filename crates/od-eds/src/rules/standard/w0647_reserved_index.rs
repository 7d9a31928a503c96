use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity};
use crate::standards::cia301::of;
use crate::subject::Object;

pub(crate) static W0647: Rule = Rule {
    code: "W0647",
    severity: Severity::Warning,
    buildable: true,
    title: "index or sub-index is reserved by CiA 301",
    why: "A later version of the standard may use it, and a tool for conformance tests rejects it.",
    source: "CiA 301, chapter 7.5",
    says: "{object} is reserved in CiA 301",
    help: "move the object to 2000h to 5FFFh (manufacturer-specific objects)",
    also: &[SUB],
    check: Check::Object(check),
    ..Rule::NEW
};

/// Sentence for a sub-index.
const SUB: Form = Form {
    says: "{object} ({name}) has no sub-index {sub} in CiA 301",
    help: "remove the sub-object, or move it to 2000h to 5FFFh (manufacturer-specific objects)",
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let index = object.index;
    let shown = Fact::Index(index);
    if matches!(index, 0x1004 | 0x100B | 0x100E | 0x100F) {
        // Earlier versions of CiA 301 define them, so a device may have them.
        let finding = W0647.on(object, object.span).severity_of(Severity::Info);
        findings.push(finding.fact("object", shown));
        return;
    }
    // FFh describes the structure of any object.
    let is_of_nodes = matches!(index, 0x1F20..=0x1F22 | 0x1F25..=0x1F27 | 0x1F81 | 0x1F84..=0x1F88);
    let last = match index {
        // The sub-index is a node ID.
        _ if is_of_nodes => 127,
        0x1018 => 4,
        0x1029 => 254,
        0x1200..=0x12FF => 3,
        0x1400..=0x15FF | 0x1800..=0x19FF => 6,
        _ => return,
    };
    let Some(standard) = of(index).filter(|_| object.code.has_members()) else {
        return;
    };
    for entry in object
        .entries()
        .filter(|entry| (last + 1..255).contains(&entry.address.sub))
    {
        let finding = W0647
            .on(&entry, entry.span)
            .form(&SUB)
            .fact("object", shown.clone());
        let finding = finding.fact("name", standard.name);
        let finding = finding.fact("sub", entry.address.sub);
        findings.push(if is_of_nodes {
            finding.severity_of(Severity::Error)
        } else {
            finding
        });
    }
}
