use alloc::string::String;

use crate::finding::{Finding, Form, Rule, Severity::Warning};
use crate::span::{Span, Spanned};

pub(crate) static RULE: Rule = Rule {
    code: "W0323",
    severity: Warning,
    title: "Count of a module is not valid",
    why: "A configuration tool adds the wrong number of sub-objects. odkit assumes 1. Count is a number, or `0;` and the number of bits in one shared sub-object.",
    source: "CiA 306-1, modular devices",
    says: "Count `{given}` is not valid",
    help: "write the number of sub-objects that a module adds, or `0;` and its bits",
    also: &[MISSING],
    ..Rule::NEW
};

/// Sentence for an extension without Count.
const MISSING: Form = Form {
    says: "Count is missing",
    ..Form::OWN
};

/// The finding about the Count of an extension that is not valid, or missing.
pub(crate) fn finding(header: Span, given: Option<&Spanned<String>>) -> Finding {
    match given {
        Some(given) => RULE.given(given),
        None => RULE.at(header).form(&MISSING),
    }
}
