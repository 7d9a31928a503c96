use alloc::format;
use alloc::string::ToString;

use crate::finding::{Finding, Fixability, Form, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;
use crate::span::Span;

pub(crate) static RULE: Rule = Rule {
    code: "W0321",
    severity: Warning,
    title: "NrOfEntries does not match its section",
    why: "Many tools read only as many entries as NrOfEntries says. odkit reads all entries.",
    source: "CiA 306-1, CompactSubObj",
    fixability: Fixability::Safe,
    says: "NrOfEntries is {given}, but the section has {found:entry|entries}",
    help: "write `NrOfEntries={found}`{fix}",
    also: &[MISSING],
    ..Rule::NEW
};

/// Sentence for a section without NrOfEntries.
const MISSING: Form = Form {
    says: "NrOfEntries is missing",
    ..Form::OWN
};

/// The finding about an NrOfEntries that is missing, or not the number of entries. It is not lowered where an entry
/// without a value is left, for which a tool may have room.
pub(crate) fn finding(
    header: Span,
    given: Option<&Text<'_>>,
    found: usize,
    has_empty: bool,
) -> Finding {
    let finding = match given {
        Some(given) if has_empty => RULE.given(given),
        Some(given) => RULE
            .given(given)
            .fix(Fix::safe().replace(given.span, found.to_string())),
        None => RULE
            .at(header)
            .form(&MISSING)
            .fix(Fix::safe().below(header, format!("NrOfEntries={found}"))),
    };
    finding.fact("found", found)
}
