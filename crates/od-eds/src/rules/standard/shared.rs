//! Parts of several rules about standard objects.

use alloc::format;

use od_model::{DataType, ObjectCode};

use crate::description::{Description, Section};
use crate::fact::{Fact, Key};
use crate::finding::{Finding, Rule};
use crate::fix::Fix;
use crate::subject::{Entry, Object};

/// The value of an object without sub-objects.
pub(super) fn value<'a>(object: &Object<'a>) -> Option<Entry<'a>> {
    let first = object.entries().next();
    first.filter(|_| !object.code.has_members())
}

/// The finding about an object that must have one of these codes.
pub(super) fn code(
    rule: &'static Rule,
    object: &Object<'_>,
    codes: &[ObjectCode],
) -> Option<Finding> {
    let right = codes.first().filter(|_| !codes.contains(&object.code))?;
    let fix = Fix::unsafe_fix().replace(object.code.span, format!("0x{:X}", right.code()));
    let finding = rule.on(object, object.code.span).key(Key::ObjectType);
    let finding = finding.fact("object", Fact::Index(object.index));
    let finding = finding.fact("right", *right).fact("given", *object.code);
    Some(finding.fix(fix))
}

/// The finding about a value that must be of this type.
pub(super) fn data_type(
    rule: &'static Rule,
    entry: &Entry<'_>,
    right: DataType,
) -> Option<Finding> {
    let given = entry.data_type.filter(|given| **given != right)?;
    let fix = Fix::unsafe_fix().replace(given.span, format!("0x{:04X}", right.code()));
    let finding = rule.on(entry, given.span).key(Key::DataType);
    let finding = finding.fact("object", entry.shown());
    Some(finding.fact("right", right).fact("given", *given).fix(fix))
}

/// `[DeviceComissioning]`, in either spelling.
pub(super) fn commissioning(description: &Description) -> Option<&Section> {
    let section = description.section("DeviceComissioning");
    section.or_else(|| description.section("DeviceCommissioning"))
}
