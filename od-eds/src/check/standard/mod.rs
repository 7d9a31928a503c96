//! The objects of the communication area are what CiA 301 and CiA 302 say.
//!
//! Guarantees that a master which knows an object from the standard can use it in this device.
//! 1000h, 1001h and 1018h are looked at in `mandatory`, PDO objects in `pdo_*`. Assumes that
//! values without a type were named.
//! Source: CiA 301, chapter 7.5; CiA 302 parts 2, 3, 4 and 6.

use alloc::format;
use alloc::vec::Vec;

use super::{named, place};
use crate::description::{Description, EntryDescription, ObjectDescription};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use od_model::{Access, Address, ObjectCode};

mod table;

use table::{Members, Standard, Value, of};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (index, object) in description.objects.range(0x1000..=0x1FFF) {
        let Some(standard) = of(*index) else { continue };
        if code(*index, object, standard, findings) {
            values(description, *index, object, standard, findings);
        }
    }
}

/// Names an object of the wrong code; may its values be compared?
fn code(
    index: u16,
    object: &ObjectDescription,
    standard: &Standard,
    findings: &mut Vec<Finding>,
) -> bool {
    let right = standard.code();
    let own = *object.code;
    // An ARRAY and a RECORD of one type are the same on the bus.
    if own == right || own.has_members() && right.has_members() {
        return true;
    }
    // A VAR of type DOMAIN is what others call a DOMAIN.
    if own == ObjectCode::Domain && right == ObjectCode::Var {
        return true;
    }
    if !matches!(index, 0x1000 | 0x1001 | 0x1018) {
        findings.push(
            rules::W0630
                .told(
                    place(&[object.code.span, object.span]),
                    format!(
                        "{index:04X}h ({}) is a {right} in {}, and a {own} here",
                        standard.name,
                        standard.source()
                    ),
                )
                .about(Address::new(index, 0))
                .with_help(format!("write `ObjectType=0x{:X}`", right.code())),
        );
    }
    false
}

fn values(
    description: &Description,
    index: u16,
    object: &ObjectDescription,
    standard: &Standard,
    findings: &mut Vec<Finding>,
) {
    match &standard.members {
        Members::Var(value) => {
            if let Some(entry) = object.entries.get(&0) {
                one(
                    description,
                    Address::new(index, 0),
                    entry,
                    value,
                    standard,
                    findings,
                );
            }
        }
        Members::Array(value) => {
            for (sub, entry) in object.entries.range(1..=254) {
                one(
                    description,
                    Address::new(index, *sub),
                    entry,
                    value,
                    standard,
                    findings,
                );
            }
            missing(index, object, 1, standard, findings);
        }
        Members::Record(members) => {
            for (sub, value, mandatory) in *members {
                match object.entries.get(sub) {
                    Some(entry) => {
                        one(
                            description,
                            Address::new(index, *sub),
                            entry,
                            value,
                            standard,
                            findings,
                        );
                    }
                    None if *mandatory => missing(index, object, *sub, standard, findings),
                    None => {}
                }
            }
        }
    }
}

fn missing(
    index: u16,
    object: &ObjectDescription,
    sub: u8,
    standard: &Standard,
    findings: &mut Vec<Finding>,
) {
    // Without any member at all, that was said; 1018h and the PDOs have rules of their own.
    let own_rule = matches!(index, 0x1018 | 0x1400..=0x1BFF);
    if object.entries.is_empty() || object.entries.contains_key(&sub) || own_rule {
        return;
    }
    findings.push(
        rules::W0633
            .told(
                object.span,
                format!("{index:04X}h ({}) has no sub-index {sub}", standard.name),
            )
            .about(Address::new(index, sub))
            .with_help(format!("write a section [{index:04X}sub{sub:X}]")),
    );
}

fn one(
    description: &Description,
    address: Address,
    entry: &EntryDescription,
    value: &Value,
    standard: &Standard,
    findings: &mut Vec<Finding>,
) {
    let own_rule = matches!(address.index, 0x1000 | 0x1001 | 0x1018)
        || matches!(address.index, 0x1400..=0x15FF | 0x1800..=0x19FF if address.sub <= 2)
        || matches!(address.index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
    let shown = named(description, address);
    if let Some(given) = entry.data_type.filter(|given| **given != value.data_type)
        && !own_rule
    {
        let right = value.data_type;
        findings.push(
            rules::W0631
                .told(
                    place(&[given.span, entry.span]),
                    format!(
                        "{shown} ({}) is {right} in {}, and {} here",
                        standard.name,
                        standard.source(),
                        *given
                    ),
                )
                .about(address)
                .with_help(format!("write `DataType=0x{:04X}`", right.code()))
                .fix(Fix::unsafe_fix().replace(given.span, format!("0x{:04X}", right.code()))),
        );
    }
    let own = *entry.access;
    let (wrong, help) = match value.access {
        // What a device sets itself, nobody writes.
        Access::Ro | Access::Const => (own.writable(), "ro"),
        // Many devices fix what they could let others set.
        Access::Rw => (own == Access::Wo, "rw"),
        Access::Wo => (!own.writable(), "wo"),
        Access::Rwr | Access::Rww => (false, ""),
    };
    if wrong {
        findings.push(
            rules::W0632
                .told(
                    place(&[entry.access.span, entry.span]),
                    format!(
                        "{shown} ({}) is {} in {}, and {own} here",
                        standard.name,
                        value.access,
                        standard.source()
                    ),
                )
                .about(address)
                .with_help(format!("write `AccessType={help}`"))
                .fix(Fix::unsafe_fix().replace(entry.access.span, help)),
        );
    }
}
