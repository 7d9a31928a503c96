use crate::finding::{Finding, Rule, Severity::Error};
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "E0208",
    severity: Error,
    title: "sub-index without its object",
    why: "A tool that reads the object finds neither its name nor its object code. odkit keeps the sub-objects in an object without a name.",
    source: "CiA 306-1, object sections",
    says: "section [{object:04X}] of this sub-object is missing",
    help: "add a section [{object:04X}] with `{ObjectType=0x9}` (RECORD) or `{ObjectType=0x8}` (ARRAY)",
    ..Rule::NEW
};

/// The finding about the first section of a sub-object without its object.
pub(crate) fn finding(member: Span, index: u16) -> Finding {
    RULE.at(member).index(index)
}
