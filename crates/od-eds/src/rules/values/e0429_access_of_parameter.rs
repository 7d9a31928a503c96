use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::span::Spanned;
use alloc::string::String;

pub(crate) static RULE: Rule = Rule {
    code: "E0429",
    severity: Error,
    buildable: true,
    title: "accessType has a word of the attribute access",
    why: "CiA 311 has one set of words for accessType of an object, and another for access of a parameter. A tool that validates the file by the schema rejects it. odkit reads the word.",
    source: "CiA 311, CANopenObject",
    fixability: Fixability::Unsafe,
    says: "`{given}` is a word for the attribute access of a parameter, not for accessType",
    help: "write `accessType=\"{right}\"`{fix}",
    ..Rule::NEW
};

/// The finding about accessType in an XDD, with the word that an object has for it.
#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
pub(crate) fn finding(given: &Spanned<String>, right: &'static str) -> Finding {
    let fix = Fix::unsafe_fix().replace(given.span, right);
    let finding = RULE.given(given).key(Key::AccessType);
    finding.fact("right", right).fix(fix)
}
