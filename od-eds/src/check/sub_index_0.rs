//! Sub-index 0 tells the highest sub-index, and tells the truth.
//!
//! Guarantees that a master which reads up to sub-index 0 gets no abort. Assumes
//! that a value which does not fit was named. In objects where sub-index 0 counts
//! entries in use (mappings, error history, what a master can write) it may be
//! lower than the members. Sub-index FFh is no member.
//! Source: CiA 301, object structure.

use alloc::format;
use alloc::vec::Vec;

use super::{place, start_number};
use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::span::token_of;
use od_model::{Address, DataType, ObjectCode};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (index, object) in &description.objects {
        if !object.code.has_members()
            || *object.code == ObjectCode::DefStruct
            || object.entries.is_empty()
        {
            continue;
        }
        let address = Address::new(*index, 0);
        let Some(count) = object.entries.get(&0) else {
            findings.push(
                rules::W0307
                    .told(object.span, "there is no sub-index 0")
                    .about(address)
                    .with_help(format!(
                        "write a section [{index:04X}sub0] with `DataType=0x0005` and the highest sub-index as its DefaultValue"
                    ))
                    .fix(missing(*index, object)),
            );
            continue;
        };
        if let Some(data_type) = count.data_type.filter(|t| **t != DataType::Unsigned8) {
            findings.push(
                rules::E0309
                    .told(
                        place(&[data_type.span, count.span]),
                        format!("sub-index 0 must be UNSIGNED8, but is {}", data_type.name()),
                    )
                    .about(address)
                    .with_help("write `DataType=0x0005`")
                    .fix(Fix::unsafe_fix().replace(data_type.span, "0x0005")),
            );
            continue;
        }
        let Some(number) = start_number(description, address) else {
            continue;
        };
        if counts_in_use(*index) && matches!(number.value, 254 | 255) {
            // A multiplexed PDO: it counts nothing.
            continue;
        }
        let highest = object
            .entries
            .range(..255)
            .next_back()
            .map_or(0, |(sub, _)| *sub);
        let in_use = count.access.writable() || counts_in_use(*index);
        let (rule, message) = if number.value > u64::from(highest) {
            (
                // A PDO that maps nothing where its count says it maps something cannot be made;
                // what stands in a macro call is the author's own to mend.
                match counts_mapped(*index) || token_of(number.span).is_some() {
                    true => &rules::E0310,
                    false => &rules::W0350,
                },
                format!(
                    "sub-index 0 is {}, but the highest member is {highest}",
                    number.value
                ),
            )
        } else if number.value < u64::from(highest) && !in_use {
            (
                &rules::W0311,
                format!(
                    "sub-index 0 is {}, but there is a member {highest}",
                    number.value
                ),
            )
        } else {
            continue;
        };
        findings.push(
            rule.told(place(&[number.span, count.span]), message)
                .about(address)
                .with_help(format!("write `DefaultValue={highest}`"))
                .fix(Fix::unsafe_fix().replace(number.span, format!("{highest}"))),
        );
    }
}

/// A sub-index 0, written before the first member.
fn missing(index: u16, object: &ObjectDescription) -> Fix {
    let Some((_, first)) = object.entries.first_key_value() else {
        return Fix::unsafe_fix();
    };
    let highest = object.entries.range(..255).next_back();
    let highest = highest.map_or(0, |(sub, _)| *sub);
    Fix::unsafe_fix().above(
        first.span,
        format!(
            "[{index:04X}sub0]\nParameterName=Highest sub-index supported\nObjectType=0x7\n\
             DataType=0x0005\nAccessType=ro\nDefaultValue={highest}\nPDOMapping=0\n"
        ),
    )
}

fn counts_mapped(index: u16) -> bool {
    matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF)
}

/// Objects whose sub-index 0 changes with what is in them.
fn counts_in_use(index: u16) -> bool {
    matches!(index, 0x1003 | 0x1600..=0x17FF | 0x1A00..=0x1BFF)
}
