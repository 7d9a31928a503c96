use alloc::string::String;

use crate::finding::{Finding, Form, Rule, Severity::Error};
use crate::span::{Span, Spanned};

pub(crate) static RULE: Rule = Rule {
    code: "E0114",
    severity: Error,
    title: "object of an XDD has no valid index",
    why: "An index has four hexadecimal digits and a sub-index two, without `0x`. odkit leaves the element out.",
    source: "CiA 311, CANopenObject",
    says: "`{given}` is not a valid {name}",
    help: "write {digits} hexadecimal digits",
    also: &[MISSING],
    ..Rule::NEW
};

/// The sentence for an element without the attribute.
const MISSING: Form = Form {
    says: "{name} is missing",
    ..Form::OWN
};

/// The finding about an index or a sub-index: an attribute that is not valid, or is missing.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn finding(
    element: Span,
    name: &str,
    given: Option<&Spanned<String>>,
    digits: usize,
) -> Finding {
    let finding = match given {
        Some(given) => RULE.given(given),
        None => RULE.at(element).form(&MISSING),
    };
    finding.fact("name", name).fact("digits", digits)
}
