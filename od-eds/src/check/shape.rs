//! Objects stand where objects stand, and their members follow each other.
//!
//! Guarantees that a master which walks an ARRAY, or looks something up by its name, finds it.
//! Assumes that object codes and members were read.
//! Source: CiA 301, object dictionary structure; CiA 306-1, object sections.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::vec::Vec;

use super::place;
use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::span::Span;
use od_model::{Address, ObjectCode};

/// The longest name of CiA 306.
const NAME: usize = 241;

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    let mut names: BTreeMap<&str, (u16, Span)> = BTreeMap::new();
    for (index, object) in &description.objects {
        area(*index, object, findings);
        flags(*index, object, findings);
        members(*index, object, findings);
        let name = object.name.value.as_str();
        long(Address::new(*index, 0), name, object.name.span, findings);
        if name.is_empty() || matches!(index, 0x1000..=0x1FFF) {
            // Standard objects are known by their index.
            continue;
        }
        match names.get(name) {
            None => drop(names.insert(name, (*index, object.name.span))),
            Some((first, span)) => findings.push(
                rules::I0346
                    .told(
                        place(&[object.name.span, object.span]),
                        format!("{index:04X}h and {first:04X}h are both called \"{name}\""),
                    )
                    .about(Address::new(*index, 0))
                    .with_label(*span, "the other one is here")
                    .with_help("give one of them another name"),
            ),
        }
    }
}

fn area(index: u16, object: &ObjectDescription, findings: &mut Vec<Finding>) {
    if matches!(index, 0 | 0x0260..=0x0FFF | 0xC000..) {
        findings.push(
            rules::W0343
                .told(object.span, format!("{index:04X}h is a reserved index"))
                .about(Address::new(index, 0))
                .with_help("objects of your own have 2000h to 5FFFh"),
        );
    }
}

fn flags(index: u16, object: &ObjectDescription, findings: &mut Vec<Finding>) {
    let own = (0, object.flags, object.span);
    let entries = object.entries.iter();
    let entries = entries.map(|(sub, entry)| (*sub, entry.flags, entry.span));
    for (sub, flags, span) in core::iter::once(own).chain(entries) {
        if flags & !3 != 0 {
            findings.push(
                rules::W0342
                    .told(
                        span,
                        format!("ObjFlags is 0x{flags:X}, but only bits 0 and 1 have a meaning"),
                    )
                    .about(Address::new(index, sub))
                    .with_help("write a number from 0 to 3"),
            );
        }
    }
}

fn members(index: u16, object: &ObjectDescription, findings: &mut Vec<Finding>) {
    if !object.code.has_members() {
        if let Some(number) = object.sub_number.filter(|number| number.value > 1) {
            findings.push(
                rules::W0352
                    .told(
                        place(&[number.span, object.span]),
                        format!(
                            "a {} has no sub-indices, but SubNumber is {}",
                            *object.code, number.value
                        ),
                    )
                    .about(Address::new(index, 0))
                    .with_help("leave SubNumber out")
                    .fix(Fix::unsafe_fix().remove_line(number.span)),
            );
        }
        return;
    }
    if *object.code == ObjectCode::Array {
        gap(index, object, findings);
    }
    let mut names: BTreeMap<&str, Span> = BTreeMap::new();
    for (sub, entry) in &object.entries {
        let address = Address::new(index, *sub);
        let name = entry.name.value.as_str();
        long(address, name, entry.name.span, findings);
        if name.is_empty() || matches!(index, 0x1000..=0x1FFF) {
            continue;
        }
        if let Some(first) = names.insert(name, entry.name.span)
            && first != entry.name.span
        {
            findings.push(
                rules::I0345
                    .told(
                        place(&[entry.name.span, entry.span]),
                        format!("two members are called \"{name}\""),
                    )
                    .about(address)
                    .with_label(first, "the other one is here")
                    .with_help("give one of them another name"),
            );
        }
    }
    if let Some(count) = object.entries.get(&0)
        && count.access.writable()
        && matches!(index, 0x1000..=0x1FFF)
        && !matches!(index, 0x1003 | 0x1600..=0x17FF | 0x1A00..=0x1BFF | 0x1F00..)
    {
        findings.push(
            rules::W0347
                .told(
                    place(&[count.access.span, count.span]),
                    format!("sub-index 0 counts the members, but is {}", *count.access),
                )
                .about(Address::new(index, 0))
                .with_help("write `AccessType=const`")
                .fix(Fix::unsafe_fix().replace(count.access.span, "const")),
        );
    }
}

fn gap(index: u16, object: &ObjectDescription, findings: &mut Vec<Finding>) {
    for (expected, (sub, entry)) in (1u16..).zip(object.entries.range(1..=254)) {
        if u16::from(*sub) != expected {
            findings.push(
                rules::W0351
                    .told(
                        entry.span,
                        format!("this ARRAY has sub-index {sub}, but no sub-index {expected}"),
                    )
                    .about(Address::new(index, *sub))
                    .with_help("number the members without a gap, or make it a RECORD"),
            );
            return;
        }
    }
}

fn long(address: Address, name: &str, span: Span, findings: &mut Vec<Finding>) {
    let length = name.chars().count();
    if length > NAME {
        findings.push(
            rules::W0344
                .told(
                    span,
                    format!("the name has {length} characters, and {NAME} are the most"),
                )
                .about(address)
                .with_help("find a shorter name"),
        );
    }
}
