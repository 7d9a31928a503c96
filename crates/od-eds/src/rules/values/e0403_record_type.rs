use alloc::vec::Vec;

use crate::finding::{Check, Finding, Rule};
use crate::rules::values::shared::WHOLE;
use crate::subject::{Entry, is_definition};
use od_model::{DataType, Kind};

pub(crate) static E0403: Rule = Rule {
    title: "value has the type of a record",
    why: "0020h to 0023h are types of RECORDs; a value has a basic type. odkit leaves the value out of the dictionary.",
    source: "CiA 301, data types",
    says: WHOLE.says,
    help: WHOLE.help,
    check: Check::Entry(check),
    ..Rule::of("E0403")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some(data_type) = entry.data_type
        && data_type.kind() == Kind::Record
        && !is_definition(entry.object)
    {
        let finding = E0403.on(entry, data_type.span).fact("type", *data_type);
        findings.push(finding.fact("right", DataType::Unsigned32));
    }
}
