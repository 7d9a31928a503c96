use alloc::format;

use crate::finding::{Finding, Fixability, Form, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0218",
    severity: Warning,
    title: "list entry is not written as `1=0x1000`",
    why: "Many tools read another index, or none, or never ask for the entry. odkit reads the entry as it is meant.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "odkit reads list entry `{given}` as {object}",
    help: "write `0x{object:04X}`{fix}",
    also: &[NUMBER],
    ..Rule::NEW
};

/// Sentence for the number of an entry.
const NUMBER: Form = Form {
    says: "odkit reads entry number `{given}` as {number}",
    help: "write `{number}`{fix}",
};

/// The finding about the index of an entry.
pub(crate) fn index(value: &Text<'_>, index: u16) -> Finding {
    let fix = Fix::safe().replace(value.span, format!("0x{index:04X}"));
    RULE.given(value).index(index).fix(fix)
}

/// The finding about the number of an entry.
pub(crate) fn number(key: &Text<'_>, number: i128) -> Finding {
    let fix = Fix::safe().replace(key.span, format!("{number}"));
    RULE.given(key)
        .form(&NUMBER)
        .fact("number", number)
        .fix(fix)
}
