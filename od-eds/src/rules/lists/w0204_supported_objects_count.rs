use alloc::format;
use alloc::string::ToString;

use crate::finding::{Finding, Fixability, Form, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0204",
    severity: Warning,
    title: "SupportedObjects does not match its list",
    why: "Many tools read only as many entries as SupportedObjects says. odkit reads all entries.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "SupportedObjects is {given}, but the list has {found:entry|entries}",
    help: "write `SupportedObjects={found}`{fix}",
    also: &[MISSING],
    ..Rule::NEW
};

/// Sentence for a list without SupportedObjects.
const MISSING: Form = Form {
    says: "SupportedObjects is missing",
    ..Form::OWN
};

/// The finding about a SupportedObjects that is missing, or not the number of entries.
pub(crate) fn finding(header: Span, given: Option<&Text<'_>>, found: i128) -> Finding {
    let finding = match given {
        Some(given) => RULE
            .given(given)
            .fix(Fix::safe().replace(given.span, found.to_string())),
        None => RULE
            .at(header)
            .form(&MISSING)
            .fix(Fix::safe().below(header, format!("SupportedObjects={found}"))),
    };
    finding.fact("found", found)
}
