use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Key;
use crate::finding::{Check, Finding, Rule};
use crate::rules::profile::shared::profile_type;
use crate::span::Span;
use crate::subject::{Entry, is_definition};
use od_model::{Address, DataType};

pub(crate) static E0401: Rule = Rule {
    title: "DataType is missing",
    why: "A tool cannot read or write a value without its type. odkit leaves the value out of the dictionary.",
    source: "CiA 306-1, object sections",
    says: "{DataType} is missing",
    help: "add `{DataType={right}}` ({right}), or another type",
    check: Check::Entry(check),
    ..Rule::of("E0401")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    // The reader has reported an unknown DataType.
    let missing = entry.data_type.is_none() && !entry.is_unread(Key::DataType);
    if missing && !is_definition(entry.object) {
        findings.push(finding(entry.description, entry.address, entry.span));
    }
}

/// The finding about a value without a type.
pub(crate) fn finding(description: &Description, address: Address, section: Span) -> Finding {
    let right = profile_type(description, address).unwrap_or(DataType::Unsigned32);
    E0401.at(section).about(address).fact("right", right)
}
