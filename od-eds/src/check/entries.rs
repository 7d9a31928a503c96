//! Type, access, mapping and default of one value go together.
//!
//! Guarantees that nothing is promised of a value which its type or access cannot keep. Assumes
//! that each of them is what it can be. Source: CiA 306-1, object sections; CiA 301, data types.

use alloc::format;
use alloc::vec::Vec;

use super::place;
use crate::description::{Description, EntryDescription, Value};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use od_model::{Access, Address, DataType};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (address, entry) in description.entries() {
        mappable(address, entry, findings);
        constant(address, entry, findings);
        text(address, entry, findings);
        one_value(address, entry, findings);
    }
}

fn mappable(address: Address, entry: &EntryDescription, findings: &mut Vec<Finding>) {
    let access = *entry.access;
    if !*entry.mappable {
        if matches!(access, Access::Rwr | Access::Rww) {
            let fix = match entry.mappable.span.line {
                0 => Fix::unsafe_fix().below(entry.access.span, "PDOMapping=1"),
                _ => Fix::unsafe_fix().replace(entry.mappable.span, "1"),
            };
            findings.push(
                rules::W0445
                    .told(
                        place(&[entry.access.span, entry.span]),
                        format!("`{access}` says which PDO may map it, but it is not mappable"),
                    )
                    .about(address)
                    .with_help("write `PDOMapping=1`, or `AccessType=rw`")
                    .fix(fix),
            );
        }
        return;
    }
    let Some(data_type) = entry.data_type else {
        return;
    };
    if data_type.bits().is_none() {
        findings.push(
            rules::W0454
                .told(
                    place(&[entry.mappable.span, entry.span]),
                    format!(
                        "a {} has no fixed length, and no place in a PDO",
                        *data_type
                    ),
                )
                .about(address)
                .with_label(data_type.span, format!("{} is declared here", *data_type))
                .with_help("write `PDOMapping=0`")
                .fix(Fix::unsafe_fix().replace(entry.mappable.span, "0")),
        );
    } else if access == Access::Rw {
        findings.push(
            rules::I0447
                .told(
                    place(&[entry.access.span, entry.span]),
                    "it is mappable, and `rw` does not say into which PDOs",
                )
                .about(address)
                .with_help("write `rwr` for TPDOs or `rww` for RPDOs, if it is for one of them"),
        );
    }
}

fn constant(address: Address, entry: &EntryDescription, findings: &mut Vec<Finding>) {
    let unread = |key: &str| entry.extra.iter().any(|(k, _)| k.eq_ignore_ascii_case(key));
    let none = entry.default.is_none() && entry.parameter.is_none();
    let text = entry
        .data_type
        .is_some_and(|t| matches!(*t, DataType::VisibleString | DataType::Domain));
    // An empty string is a value, and is not written.
    if *entry.access == Access::Const && none && !text && !unread("DefaultValue") {
        findings.push(
            rules::W0453
                .told(
                    place(&[entry.access.span, entry.span]),
                    "a constant has no DefaultValue",
                )
                .about(address)
                .with_help("write the value, or `AccessType=ro` if it can change"),
        );
    }
}

fn text(address: Address, entry: &EntryDescription, findings: &mut Vec<Finding>) {
    let Some(value) = &entry.default else { return };
    if let Value::Text(text) = &value.value
        && let Some(odd) = text.chars().find(|c| !matches!(c, ' '..='~'))
    {
        findings.push(
            rules::W0446
                .told(
                    place(&[value.span, entry.span]),
                    format!("{odd:?} is no character of a VISIBLE_STRING"),
                )
                .about(address)
                .with_help("use the characters of ISO 646 (ASCII), from the blank to `~`"),
        );
    }
}

fn one_value(address: Address, entry: &EntryDescription, findings: &mut Vec<Finding>) {
    let (Some(low), Some(high)) = (&entry.low, &entry.high) else {
        return;
    };
    if low.value == high.value && entry.access.writable() {
        findings.push(
            rules::I0450
                .told(
                    place(&[high.span, entry.span]),
                    format!(
                        "between the limits there is one value for a {} object",
                        *entry.access
                    ),
                )
                .about(address)
                .with_label(low.span, "LowLimit is here")
                .with_help("write the limits that the device has, or leave both empty"),
        );
    }
}
