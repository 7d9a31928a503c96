//! Rules about values and limits that are not valid for their DataType.

use alloc::vec::Vec;

use od_model::DataType;

use crate::description::Value;
use crate::fact::Key;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::values::shared::{DECLARED, FORMULA, NOT_VALID, data_type, unfit, values};
use crate::scan::section::Text;
use crate::span::Spanned;
use crate::subject::Entry;

pub(crate) static E0412: Rule = Rule {
    title: "DefaultValue is not valid for its DataType",
    why: "A tool cannot use a default value that its type does not allow. odkit leaves it out of the dictionary.",
    source: "CiA 306-1, object sections; CiA 301, data types",
    says: NOT_VALID,
    help: "write {form}",
    also: &[FORMULA],
    check: Check::Entry(|entry, findings| {
        report_unfit(&E0412, entry, &[Key::DefaultValue], findings)
    }),
    ..Rule::of("E0412")
};

pub(crate) static E0413: Rule = Rule {
    title: "ParameterValue is not valid for its DataType",
    why: "A tool cannot configure a device with a value that its type does not allow. odkit uses the default value.",
    source: "CiA 306-1, DCF; CiA 301, data types",
    says: NOT_VALID,
    help: "write {form}",
    also: &[FORMULA],
    check: Check::Entry(|entry, findings| {
        report_unfit(&E0413, entry, &[Key::ParameterValue], findings)
    }),
    ..Rule::of("E0413")
};

pub(crate) static W0416: Rule = Rule {
    title: "limit is not valid for its DataType",
    why: "The type cannot reach such a limit. odkit leaves the limit out of the dictionary.",
    source: "CiA 306-1, LowLimit and HighLimit",
    fixability: Fixability::Unsafe,
    says: NOT_VALID,
    help: "write {form}, or `{key=}`{fix}",
    also: &[FORMULA, W0416_NO_LIMITS],
    check: Check::Entry(check_limits),
    ..Rule::of("W0416")
};

/// The sentences for a limit whose type has no order.
const W0416_NO_LIMITS: Form = Form {
    says: "{type} has no limits, but {key} is `{given}`",
    help: "write `{key=}`{fix}, or remove the line",
};

fn check_limits(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let first = findings.len();
    report_unfit(&W0416, entry, &[Key::LowLimit, Key::HighLimit], findings);
    for finding in &mut findings[first..] {
        *finding = w0416_emptied(finding.clone());
    }
}

/// The finding with a fix that empties the limit, which limits nothing.
pub(crate) fn w0416_emptied(finding: Finding) -> Finding {
    match finding.span() {
        Some(span) => finding.fix(Fix::unsafe_fix().replace(span, "")),
        None => finding,
    }
}

pub(crate) fn w0416_no_limits(key: Key, given: &Text<'_>, data_type: Spanned<DataType>) -> Finding {
    let finding = W0416
        .given(given)
        .form(&W0416_NO_LIMITS)
        .key(key)
        .fact("type", *data_type);
    w0416_emptied(finding.related(data_type.span, DECLARED))
}

/// Reports the values under these keys that are not valid for their type. Other rules are about
/// formulas.
fn report_unfit(rule: &'static Rule, entry: &Entry<'_>, keys: &[Key], findings: &mut Vec<Finding>) {
    let Some(data_type) = data_type(entry) else {
        return;
    };
    for (key, value) in values(entry).filter(|(key, _)| keys.contains(key)) {
        if !matches!(value.value, Value::NodeId(_)) && !value.fits(*data_type) {
            let span = value.span.or(entry.span);
            let finding = unfit(rule, key, value.value.clone(), span, data_type);
            findings.push(finding.about(entry.address));
        }
    }
}
