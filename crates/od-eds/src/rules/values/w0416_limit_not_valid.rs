use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Fixability, Form, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::rules::values::shared::{DECLARED, FORMULA, NOT_VALID, report_unfit};
use crate::scan::placed::Text;
use crate::span::Spanned;
use crate::subject::Entry;
use od_model::DataType;

pub(crate) static W0416: Rule = Rule {
    code: "W0416",
    severity: Warning,
    title: "limit is not valid for its DataType",
    why: "The type cannot reach such a limit. odkit leaves the limit out of the dictionary.",
    source: "CiA 306-1, LowLimit and HighLimit",
    fixability: Fixability::Unsafe,
    says: NOT_VALID,
    help: "write {form}, or `{key=}`{fix}",
    also: &[FORMULA, NO_LIMITS],
    check: Check::Entry(check),
    ..Rule::NEW
};

/// The sentences for a limit whose type has no order.
const NO_LIMITS: Form = Form {
    says: "{type} has no limits, but {key} is `{given}`",
    help: "write `{key=}`{fix}, or remove the line",
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let first = findings.len();
    report_unfit(&W0416, entry, &[Key::LowLimit, Key::HighLimit], findings);
    for finding in &mut findings[first..] {
        *finding = emptied(finding.clone());
    }
}

/// The finding with a fix: the limit is emptied, for it limits nothing.
pub(crate) fn emptied(finding: Finding) -> Finding {
    match finding.span() {
        Some(span) => finding.fix(Fix::unsafe_fix().replace(span, "")),
        None => finding,
    }
}

/// The finding about a limit of a type that has none.
pub(crate) fn no_limits(key: Key, given: &Text<'_>, data_type: Spanned<DataType>) -> Finding {
    let finding = W0416
        .given(given)
        .form(&NO_LIMITS)
        .key(key)
        .fact("type", *data_type);
    emptied(finding.related(data_type.span, DECLARED))
}
