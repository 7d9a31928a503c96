use alloc::string::String;

use crate::finding::{Finding, Form, Rule, Severity::Warning};
use crate::span::{Span, Spanned};

pub(crate) static RULE: Rule = Rule {
    code: "W0323",
    severity: Warning,
    title: "Count of a module is none",
    why: "Count says how many sub-indices a module adds: a number, or `0;` and the bits that share one. One is taken.",
    source: "CiA 306-1, modular devices",
    says: "`{given}` is no Count",
    help: "write how many sub-indices a module adds, or `0;` and its bits",
    also: &[MISSING],
    ..Rule::NEW
};

/// What an extension without Count says.
const MISSING: Form = Form {
    says: "there is no Count",
    ..Form::OWN
};

/// The finding about the Count of an extension that is not valid, or missing.
pub(crate) fn finding(header: Span, given: Option<&Spanned<String>>) -> Finding {
    match given {
        Some(given) => RULE.given(given),
        None => RULE.at(header).form(&MISSING),
    }
}
