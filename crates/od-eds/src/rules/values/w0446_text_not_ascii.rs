use alloc::format;
use alloc::vec::Vec;

use crate::description::Value;
use crate::finding::{Check, Finding, Rule};
use crate::subject::Entry;

pub(crate) static W0446: Rule = Rule {
    title: "text is not ASCII",
    why: "A VISIBLE_STRING has the characters of ISO 646. A master may show other characters wrongly.",
    source: "CiA 301, data types",
    says: "{odd} is not a valid character of a VISIBLE_STRING",
    help: "write only characters of ISO 646 (ASCII), from the blank to `~`",
    check: Check::Entry(check),
    ..Rule::of("W0446")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Some(value) = &entry.default else { return };
    if let Value::Text(text) = &value.value
        && let Some(odd) = text.chars().find(|c| !matches!(c, ' '..='~'))
    {
        findings.push(W0446.on(entry, value.span).fact("odd", format!("{odd:?}")));
    }
}
