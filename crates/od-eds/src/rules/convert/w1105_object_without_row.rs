use crate::finding::{Finding, Rule, Severity::Warning};
use crate::span::Span;
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1105",
    severity: Warning,
    title: "CANopenNode has no row for the object",
    why: "The list of objects of OD.c ends at index 0, and an object has at most 255 sub-objects. odkit leaves out the object, or its last sub-object; a node aborts each request for it.",
    source: "CANopenNode 4, 301/CO_ODinterface.h: OD_entry_t",
    example: "[2100], an ARRAY with sub-indices 0 to 255",
    says: "an object dictionary of CANopenNode cannot have this object",
    ..Rule::NEW
};

/// The finding about an object, or a sub-object, that is left out.
pub(crate) fn finding(address: Address, section: Span) -> Finding {
    RULE.at(section).about(address)
}
