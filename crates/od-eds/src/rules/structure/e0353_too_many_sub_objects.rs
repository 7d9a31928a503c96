use crate::fact::Key;
use crate::finding::{Finding, Rule, Severity::Error};
use crate::log::EXPANDED;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "E0353",
    severity: Error,
    title: "too many sub-objects without a section",
    why: "No CANopen device has a million sub-objects, and a tool that creates them runs out of memory. odkit keeps sub-index 0 of the objects that are too many.",
    source: "odkit, limits of a description; CiA 306-1, CompactSubObj",
    example: "4,000 arrays with `CompactSubObj=254`",
    says: "{CompactSubObj} brings the file to more than {limit} sub-objects without a section",
    help: "remove objects, or write a smaller {CompactSubObj}",
    ..Rule::NEW
};

/// The finding about a count of sub-objects that is too much.
pub(crate) fn finding(count: Span) -> Finding {
    RULE.at(count)
        .key(Key::CompactSubObj)
        .fact("limit", EXPANDED)
}
