use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::values::shared::{FORMULA, report_unfit};
use crate::subject::Entry;

pub(crate) static RULE: Rule = Rule {
    code: "E0413",
    severity: Error,
    title: "ParameterValue is no value of its type",
    why: "The value cannot be what the configuration says it is. The dictionary has the default there.",
    source: "CiA 306-1, DCF; CiA 301, data types",
    says: "{key} `{given}` is no {type}",
    help: "write {form}",
    also: &[FORMULA],
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    report_unfit(&RULE, entry, &[Key::ParameterValue], findings);
}
