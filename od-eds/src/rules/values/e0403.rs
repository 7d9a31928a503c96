use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::subject::{Entry, is_definition};
use od_model::Kind;

pub(crate) static RULE: Rule = Rule {
    code: "E0403",
    severity: Error,
    title: "value has the type of a record",
    why: "0020h–0023h describe whole objects; a value has one of the basic types. It is left out of the dictionary.",
    source: "CiA 301, data types",
    says: "{type} is the type of a whole object",
    help: "write the type of this one value, for example `{DataType=0x0007}` for UNSIGNED32",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some(data_type) = entry.data_type
        && data_type.kind() == Kind::Record
        && !is_definition(entry.object)
    {
        findings.push(RULE.on(entry, data_type.span).fact("type", *data_type));
    }
}
