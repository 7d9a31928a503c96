//! The three objects that every CANopen device has, as CiA 301 has them.
//!
//! Guarantees 1000h, 1001h and 1018h with the types that every service relies
//! on; their access is looked at with that of the other standard objects. Assumes nothing. Source: CiA 301, objects 1000h, 1001h and 1018h.

use alloc::format;
use alloc::vec::Vec;

use super::{named, place};
use crate::description::{Description, EntryDescription, ObjectDescription};
use crate::finding::Finding;
use crate::finding::Rule;
use crate::fix::Fix;
use crate::rules;
use crate::span::Span;
use od_model::{Address, DataType, ObjectCode};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    if description.objects.is_empty() {
        findings.push(
            rules::E0210
                .told(Span::default(), "there are no objects")
                .with_help("an object is a section such as [1000]"),
        );
        return;
    }
    for (index, name, missing) in [
        (0x1000, "Device type", &rules::E0601),
        (0x1001, "Error register", &rules::E0602),
        (0x1018, "Identity object", &rules::E0603),
    ] {
        let address = Address::new(index, 0);
        match description.objects.get(&index) {
            None => findings.push(
                missing
                    .told(
                        Span::default(),
                        format!("there is no object {index:04X}h ({name})"),
                    )
                    .about(address)
                    .with_help(format!("write a section [{index:04X}]")),
            ),
            Some(object) if index == 0x1018 => identity(description, object, findings),
            Some(object) => {
                let (data_type, rule) = match index {
                    0x1000 => (DataType::Unsigned32, &rules::E0604),
                    _ => (DataType::Unsigned8, &rules::E0605),
                };
                code(rule, address, object, &[ObjectCode::Var], findings);
                if let (false, Some(value)) = (object.code.has_members(), object.entries.get(&0)) {
                    entry(
                        rule,
                        &named(description, address),
                        address,
                        value,
                        data_type,
                        findings,
                    );
                }
            }
        }
    }
}

fn identity(description: &Description, object: &ObjectDescription, findings: &mut Vec<Finding>) {
    let address = Address::new(0x1018, 0);
    let codes = [ObjectCode::Record, ObjectCode::Array];
    code(&rules::E0606, address, object, &codes, findings);
    if !object.code.has_members() {
        return;
    }
    if !object.entries.contains_key(&1) {
        findings.push(
            rules::E0606
                .told(object.span, "1018h has no sub-index 1 (vendor ID)")
                .about(address)
                .with_help("write a section [1018sub1]"),
        );
    }
    for (sub, value) in object.entries.range(1..=4) {
        let address = Address::new(0x1018, *sub);
        entry(
            &rules::E0606,
            &named(description, address),
            address,
            value,
            DataType::Unsigned32,
            findings,
        );
    }
}

fn code(
    rule: &'static Rule,
    address: Address,
    object: &ObjectDescription,
    codes: &[ObjectCode],
    findings: &mut Vec<Finding>,
) {
    if codes.contains(&object.code) {
        return;
    }
    let Some(right) = codes.first() else { return };
    let index = address.index;
    findings.push(
        rule.told(
            place(&[object.code.span, object.span]),
            format!("{index:04X}h must be a {right}, but is a {}", *object.code),
        )
        .about(address)
        .with_help(format!("write `ObjectType=0x{:X}`", right.code()))
        .fix(Fix::unsafe_fix().replace(object.code.span, format!("0x{:X}", right.code()))),
    );
}

fn entry(
    rule: &'static Rule,
    shown: &str,
    address: Address,
    entry: &EntryDescription,
    data_type: DataType,
    findings: &mut Vec<Finding>,
) {
    if let Some(given) = entry.data_type.filter(|given| **given != data_type) {
        findings.push(
            rule.told(
                place(&[given.span, entry.span]),
                format!("{shown} must be {data_type}, but is {}", *given),
            )
            .about(address)
            .with_help(format!("write `DataType=0x{:04X}`", data_type.code()))
            .fix(Fix::unsafe_fix().replace(given.span, format!("0x{:04X}", data_type.code()))),
        );
    }
}
