//! Objects with members have them, count them, and an ARRAY's are of one type.
//!
//! Guarantees that a reader that trusts SubNumber sees every member, or was
//! warned. Assumes nothing. Source: CiA 306-1, object sections; CiA 301, object codes.

use alloc::format;
use alloc::vec::Vec;

use super::place;
use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use od_model::{Address, ObjectCode};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (index, object) in &description.objects {
        if !object.code.has_members() || *object.code == ObjectCode::DefStruct {
            continue;
        }
        let address = Address::new(*index, 0);
        if object.entries.is_empty() {
            if object.extra.iter().any(|(key, _)| key == "CompactSubObj") {
                // It was to have some; the reader could not tell how many, and said so.
                continue;
            }
            findings.push(
                rules::W0306
                    .told(object.span, format!("the {} has no members", *object.code))
                    .about(address)
                    .with_help(format!(
                        "write a section [{index:04X}sub0] and one for every member"
                    )),
            );
            continue;
        }
        let count = object.entries.len();
        if let Some(number) = object.sub_number.filter(|n| n.value as usize != count) {
            findings.push(
                rules::W0308
                    .told(
                        place(&[number.span, object.span]),
                        format!(
                            "SubNumber is {}, but the object has {count} sub-ind{}",
                            number.value,
                            if count == 1 { "ex" } else { "ices" }
                        ),
                    )
                    .about(address)
                    .with_help(format!("write `SubNumber={count}`"))
                    .fix(Fix::safe().replace(number.span, format!("{count}"))),
            );
        }
        if *object.code == ObjectCode::Array {
            one_type(*index, object, findings);
        }
    }
}

fn one_type(index: u16, object: &ObjectDescription, findings: &mut Vec<Finding>) {
    let mut typed = object
        .entries
        .range(1..=254)
        .filter_map(|(sub, entry)| Some((sub, entry.data_type?)));
    let Some((_, first)) = typed.next() else {
        return;
    };
    if let Some((sub, other)) = typed.find(|(_, other)| *other != first) {
        findings.push(
            rules::W0312
                .told(
                    place(&[other.span, object.span]),
                    format!(
                        "a member of this ARRAY is {}, another {}",
                        other.name(),
                        first.name()
                    ),
                )
                .about(Address::new(index, *sub))
                .with_label(first.span, format!("{} is declared here", first.name()))
                .with_label(object.code.span, "ARRAY is declared here")
                .with_help("write `ObjectType=0x9` (RECORD) if the types are right")
                .fix(Fix::unsafe_fix().replace(object.code.span, "0x9")),
        );
    }
}
