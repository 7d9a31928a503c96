use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity};
use crate::standards::cia301::{has_node_ids, of};
use crate::subject::Object;

pub(crate) static W0647: Rule = Rule {
    buildable: true,
    title: "index or sub-index is reserved by CiA 301",
    why: "A later version of the standard may use it, and a tool for conformance tests rejects it.",
    source: "CiA 301, chapter 7.5",
    says: "{object} is reserved in CiA 301",
    help: "move the object to 2000h to 5FFFh (manufacturer-specific objects)",
    also: &[SUB],
    check: Check::Object(check),
    ..Rule::of("W0647")
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
    let is_of_nodes = has_node_ids(index);
    let last = match index {
        // 128 is all nodes.
        0x1F82 | 0x1F83 => 128,
        _ if is_of_nodes => 127,
        0x1018 => 4,
        0x1600..=0x17FF | 0x1A00..=0x1BFF => 64,
        0x1029 => 254,
        0x1200..=0x12FF => 3,
        0x1400..=0x15FF | 0x1800..=0x19FF => 6,
        _ => return,
    };
    let Some(standard) = of(index).filter(|_| object.code.has_members()) else {
        return;
    };
    // Earlier versions of CiA 301, and the records 0020h and 0022h, define them. Said once for all PDOs.
    let (first, older): (u16, &[u8]) = match index {
        0x1200 => (index, &[3]),
        0x1400..=0x15FF => (0x1400, &[4, 6]),
        0x1800..=0x19FF => (0x1800, &[4]),
        _ => (index, &[]),
    };
    let mut before = object.description.objects.range(first..index);
    let is_said = before.any(|(_, own)| older.iter().any(|sub| own.entries.contains_key(sub)));
    let older = if is_said { &[] } else { older };
    let is_reserved = |sub: u8| (last + 1..255).contains(&sub) || older.contains(&sub);
    for entry in object
        .entries()
        .filter(|entry| is_reserved(entry.address.sub))
    {
        let finding = W0647
            .on(&entry, entry.origin())
            .form(&SUB)
            .fact("object", shown.clone());
        let finding = finding.fact("name", standard.name);
        let finding = finding.fact("sub", entry.address.sub);
        findings.push(if is_of_nodes {
            finding.severity_of(Severity::Error)
        } else if older.contains(&entry.address.sub) {
            finding.severity_of(Severity::Info)
        } else {
            finding
        });
    }
}
