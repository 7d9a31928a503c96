use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::values::shared::{FORMULA, report_unfit};
use crate::subject::Entry;

pub(crate) static RULE: Rule = Rule {
    code: "E0412",
    severity: Error,
    title: "DefaultValue is no value of its type",
    why: "The value cannot be what the description says it is. The dictionary has no default there.",
    source: "CiA 306-1, object sections; CiA 301, data types",
    says: "{key} `{given}` is no {type}",
    help: "write {form}",
    also: &[FORMULA],
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    report_unfit(&RULE, entry, &[Key::DefaultValue], findings);
}
