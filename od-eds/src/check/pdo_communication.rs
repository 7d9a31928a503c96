//! A PDO has its two objects, and its communication parameter what it needs.
//!
//! Guarantees that COB-ID and transmission type exist with their types. Assumes
//! that values which do not fit were named.
//! Source: CiA 301, PDO communication parameter.

use alloc::format;
use alloc::vec::Vec;

use super::{place, start_number};
use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use od_model::{Address, DataType};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (index, object) in description.objects.range(0x1400..=0x1BFF) {
        let (other, what) = match index {
            0x1400..=0x15FF | 0x1800..=0x19FF => (index + 0x200, "mapping"),
            _ => (index - 0x200, "communication"),
        };
        if !description.objects.contains_key(&other) {
            findings.push(
                rules::W0508
                    .told(
                        object.span,
                        format!("{index:04X}h has no {what} parameter {other:04X}h"),
                    )
                    .about(Address::new(*index, 0))
                    .with_help(format!("write a section [{other:04X}]")),
            );
        }
        if what == "mapping" {
            communication(description, *index, object, findings);
        }
    }
}

fn communication(
    description: &Description,
    index: u16,
    object: &ObjectDescription,
    findings: &mut Vec<Finding>,
) {
    for (sub, what, data_type) in [
        (1, "COB-ID", DataType::Unsigned32),
        (2, "transmission type", DataType::Unsigned8),
    ] {
        let address = Address::new(index, sub);
        let entry = object.entries.get(&sub);
        let Some(entry) = entry.filter(|_| object.code.has_members()) else {
            findings.push(
                rules::E0509
                    .told(object.span, format!("there is no sub-index {sub} ({what})"))
                    .about(Address::new(index, 0))
                    .with_help(format!("write a section [{index:04X}sub{sub}]")),
            );
            continue;
        };
        if let Some(given) = entry.data_type.filter(|given| **given != data_type) {
            findings.push(
                rules::E0509
                    .told(
                        place(&[given.span, entry.span]),
                        format!("the {what} must be {data_type}, but is {}", *given),
                    )
                    .about(address)
                    .with_help(format!("write `DataType=0x{:04X}`", data_type.code()))
                    .fix(
                        Fix::unsafe_fix()
                            .replace(given.span, format!("0x{:04X}", data_type.code())),
                    ),
            );
        }
    }
    let address = Address::new(index, 2);
    if let Some(number) = start_number(description, address) {
        let (last, rpdo) = match index {
            ..0x1800 => (253, true),
            _ => (251, false),
        };
        if (241..=last).contains(&number.value) {
            findings.push(
                rules::W0511
                    .told(
                        place(&[number.span, object.span]),
                        format!("transmission type {} is reserved", number.value),
                    )
                    .about(address)
                    .with_help(match rpdo {
                        true => "an RPDO has 0–240, 254 or 255",
                        false => "a TPDO has 0–240 or 252–255",
                    }),
            );
        }
    }
}
