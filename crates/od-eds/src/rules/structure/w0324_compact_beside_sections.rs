use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0324",
    severity: Warning,
    title: "CompactSubObj beside sub-index sections",
    why: "Some tools read CompactSubObj, others the sections. odkit reads both; without a DataType it ignores CompactSubObj.",
    source: "CiA 306-1, CompactSubObj",
    says: "{CompactSubObj} replaces the sections of the sub-objects, but this object has such sections",
    help: "remove {CompactSubObj}, or remove {SubNumber} and the sections",
    ..Rule::NEW
};

/// The finding about a CompactSubObj of an object that has sections of sub-objects.
pub(crate) fn finding(count: Span) -> Finding {
    RULE.at(count).key(Key::CompactSubObj)
}
