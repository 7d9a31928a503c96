use alloc::format;
use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::is_communication;
use crate::subject::Object;
use od_model::DataType;

pub(crate) static E0509: Rule = Rule {
    title: "PDO communication parameter lacks COB-ID or transmission type",
    why: "Sub-index 1 is the COB-ID, an UNSIGNED32; sub-index 2 is the transmission type, an UNSIGNED8. A master needs both to configure the PDO.",
    source: "CiA 301, PDO communication parameter",
    fixability: Fixability::Unsafe,
    says: "sub-index {sub} ({what}) is missing",
    help: "add {missing}",
    also: &[TYPE],
    check: Check::Object(check),
    ..Rule::of("E0509")
};

/// The sentences for a value of another type.
const TYPE: Form = Form {
    says: "{what} is {given} but must be {right}",
    help: "write `{DataType={right}}`{fix}",
};

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    if !is_communication(object.index) {
        return;
    }
    for (sub, what, right) in [
        (1, "COB-ID", DataType::Unsigned32),
        (2, "transmission type", DataType::Unsigned8),
    ] {
        let mut entries = object.entries().filter(|_| object.code.has_members());
        let Some(entry) = entries.find(|entry| entry.address.sub == sub) else {
            let finding = E0509
                .on(object, object.span)
                .fact("sub", sub)
                .fact("what", what);
            findings.push(finding.fact("missing", Fact::Section(object.index, Some(sub))));
            continue;
        };
        if let Some(given) = entry.data_type.filter(|given| **given != right) {
            let code = format!("0x{:04X}", right.code());
            let finding = E0509.on(&entry, given.span).form(&TYPE).fact("what", what);
            let finding = finding.fact("right", right).fact("given", *given);
            findings.push(finding.fix(Fix::unsafe_fix().replace(given.span, code)));
        }
    }
}
