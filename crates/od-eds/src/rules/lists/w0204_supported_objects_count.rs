use alloc::format;
use alloc::string::ToString;

use crate::finding::{Finding, Fixability, Form, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::scan::placed::Text;
use crate::span::Span;
#[cfg(feature = "xdd")]
use crate::span::Spanned;
#[cfg(feature = "xdd")]
use alloc::string::String;

pub(crate) static RULE: Rule = Rule {
    code: "W0204",
    severity: Warning,
    title: "SupportedObjects does not match its list",
    why: "Many tools read only as many entries as SupportedObjects says. odkit reads all entries.",
    source: "CiA 306-1, object lists",
    fixability: Fixability::Safe,
    says: "SupportedObjects is {given}, but the list has {found:entry|entries}",
    help: "write `SupportedObjects={found}`{fix}",
    also: &[MISSING, XDD],
    ..Rule::NEW
};

/// Sentence for a list without SupportedObjects.
const MISSING: Form = Form {
    says: "SupportedObjects is missing",
    ..Form::OWN
};

/// Sentence for the object list of an XDD.
const XDD: Form = Form {
    says: "{name} is {given}, but the list has {found:object|objects} of this kind",
    help: "write `{name}=\"{found}\"`{fix}",
};

/// The finding about a count in the object list of an XDD.
#[cfg(feature = "xdd")]
pub(crate) fn in_xdd(given: &Spanned<String>, name: &'static str, found: usize) -> Finding {
    let fix = Fix::safe().replace(given.span, found.to_string());
    let finding = RULE.given(given).form(&XDD).fact("name", name);
    finding.fact("found", found).fix(fix)
}

/// The finding about a SupportedObjects that is missing, or not the number of entries. A tool that counts would lose
/// an entry whose number is above a lower count, so the finding has no fix then.
pub(crate) fn finding(
    header: Span,
    given: Option<&Text<'_>>,
    found: i128,
    highest: i128,
) -> Finding {
    let finding = match given {
        Some(given) if highest > found => RULE.given(given),
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
