use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::values::shared::{FORMULA, NOT_VALID, report_unfit};
use crate::subject::Entry;

pub(crate) static E0413: Rule = Rule {
    code: "E0413",
    severity: Error,
    title: "ParameterValue is not valid for its DataType",
    why: "A tool cannot configure a device with a value that its type does not allow. odkit uses the default value.",
    source: "CiA 306-1, DCF; CiA 301, data types",
    says: NOT_VALID,
    help: "write {form}",
    also: &[FORMULA],
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    report_unfit(&E0413, entry, &[Key::ParameterValue], findings);
}
