use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Rule, Severity::Error};
use crate::rules::values::shared::{FORMULA, NOT_VALID, report_unfit};
use crate::subject::Entry;

pub(crate) static E0412: Rule = Rule {
    code: "E0412",
    severity: Error,
    title: "DefaultValue is not valid for its DataType",
    why: "A tool cannot use a default value that its type does not allow. odkit leaves it out of the dictionary.",
    source: "CiA 306-1, object sections; CiA 301, data types",
    says: NOT_VALID,
    help: "write {form}",
    also: &[FORMULA],
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    report_unfit(&E0412, entry, &[Key::DefaultValue], findings);
}
