use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Rule};
use crate::span::Spanned;
use crate::subject::Entry;
use od_model::{Access, DataType};

pub(crate) static W0453: Rule = Rule {
    title: "constant has no value",
    why: "A `const` value never changes, so DefaultValue is its value. odkit assumes 0.",
    source: "CiA 306-1, AccessType",
    says: "`const` object has no {DefaultValue}",
    help: "add {DefaultValue}, or write `{AccessType=ro}` if the value can change",
    check: Check::Entry(check),
    ..Rule::of("W0453")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let none = entry.default.is_none() && entry.parameter.is_none();
    let none = none && !entry.is_unread(Key::DefaultValue);
    // An empty string is a value, although the file does not contain it.
    let text =
        |given: Spanned<DataType>| matches!(*given, DataType::VisibleString | DataType::Domain);
    if *entry.access == Access::Const && none && !entry.data_type.is_some_and(text) {
        findings.push(W0453.on(entry, entry.access.span));
    }
}
