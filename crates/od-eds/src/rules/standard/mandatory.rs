//! The mandatory objects 1000h, 1001h and 1018h: they exist, and 1000h and 1001h are as CiA 301 specifies.

use alloc::vec::Vec;

use od_model::{Address, DataType, ObjectCode};

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::rules::standard::shared::{code, data_type, value};
use crate::subject::Object;

pub(crate) static E0601: Rule = Rule {
    title: "object 1000h is missing",
    why: "A master reads the device type first, and gets an abort.",
    source: "CiA 301, object 1000h",
    says: "mandatory object 1000h (device type) is missing",
    help: "add {missing}",
    check: Check::Device(|description, findings| {
        findings.extend(missing(&E0601, description, 0x1000))
    }),
    ..Rule::of("E0601")
};

pub(crate) static E0602: Rule = Rule {
    title: "object 1001h is missing",
    why: "A master that reads the error register gets an abort. EMCY messages carry its value.",
    source: "CiA 301, object 1001h",
    says: "mandatory object 1001h (error register) is missing",
    help: "add {missing}",
    check: Check::Device(|description, findings| {
        findings.extend(missing(&E0602, description, 0x1001))
    }),
    ..Rule::of("E0602")
};

pub(crate) static E0603: Rule = Rule {
    title: "object 1018h is missing",
    why: "A master cannot identify the device.",
    source: "CiA 301, object 1018h",
    says: "mandatory object 1018h (identity object) is missing",
    help: "add {missing}",
    check: Check::Device(|description, findings| {
        findings.extend(missing(&E0603, description, 0x1018))
    }),
    ..Rule::of("E0603")
};

pub(crate) static E0604: Rule = Rule {
    title: "object 1000h differs from CiA 301",
    why: "A master that reads 1000h as an UNSIGNED32 VAR gets another length, or an abort.",
    source: "CiA 301, object 1000h",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA 301 specifies {right}",
    help: "write `{key={right}}`{fix}",
    check: Check::Object(|object, findings| {
        differs(&E0604, object, 0x1000, DataType::Unsigned32, findings)
    }),
    ..Rule::of("E0604")
};

pub(crate) static E0605: Rule = Rule {
    title: "object 1001h differs from CiA 301",
    why: "A master that reads 1001h as an UNSIGNED8 VAR gets another length, or an abort.",
    source: "CiA 301, object 1001h",
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA 301 specifies {right}",
    help: "write `{key={right}}`{fix}",
    check: Check::Object(|object, findings| {
        differs(&E0605, object, 0x1001, DataType::Unsigned8, findings)
    }),
    ..Rule::of("E0605")
};

/// The finding about a mandatory object that is missing; none for a file without objects, which
/// has a rule of its own.
fn missing(rule: &'static Rule, description: &Description, index: u16) -> Option<Finding> {
    let objects = &description.objects;
    let is_missing = !objects.is_empty() && !objects.contains_key(&index);
    let finding = rule.finding().about(Address::new(index, 0));
    is_missing.then(|| finding.fact("missing", Fact::Section(index, None)))
}

/// Reports that the object with this index is not a VAR of this type.
fn differs(
    rule: &'static Rule,
    object: &Object<'_>,
    index: u16,
    right: DataType,
    findings: &mut Vec<Finding>,
) {
    if object.index == index {
        findings.extend(code(rule, object, &[ObjectCode::Var]));
        findings.extend(value(object).and_then(|entry| data_type(rule, &entry, right)));
    }
}
