//! A device that says in 1000h which profile it follows has the objects of that profile.
//!
//! Guarantees that a master which drives devices by their profile finds what it drives them by.
//! Assumes that 1000h is sound. Source: CiA 401, 402, 404 and 406, mandatory objects.

use alloc::format;
use alloc::vec::Vec;

use super::{named, place, start_number};
use crate::description::Description;
use crate::finding::Finding;
use crate::finding::Rule;
use crate::fix::Fix;
use crate::rules;
use od_model::Address;

pub(super) mod encoder;
mod encoder_values;
mod table;

use table::{Object, of};

/// What 1000h says: the profile, and its 16 bits about the device.
#[derive(Clone, Copy)]
struct DeviceType {
    profile: u16,
    additional: u16,
}

fn device_type(description: &Description) -> Option<DeviceType> {
    let number = start_number(description, Address::new(0x1000, 0))?;
    let number = u32::try_from(number.value).ok()?;
    let [a, b, c, d] = number.to_le_bytes();
    Some(DeviceType {
        profile: u16::from_le_bytes([a, b]),
        additional: u16::from_le_bytes([c, d]),
    })
}

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(device) = device_type(description) else {
        return;
    };
    match device.profile {
        401 => io_module(description, device, findings),
        402 => drive(description, findings),
        404 => measuring(description, device, findings),
        406 => encoder::check(description, device, findings),
        _ => return,
    }
    types(description, device.profile, findings);
}

/// Names a mandatory object that is not there: one of these would do.
fn need(
    description: &Description,
    rule: &'static Rule,
    any_of: &[u16],
    why: &str,
    findings: &mut Vec<Finding>,
) {
    if any_of
        .iter()
        .any(|index| description.objects.contains_key(index))
    {
        return;
    }
    let Some(first) = any_of.first() else { return };
    let list: Vec<_> = any_of.iter().map(|index| format!("{index:04X}h")).collect();
    let span = start_number(description, Address::new(0x1000, 0)).map(|number| number.span);
    findings.push(
        rule.told(
            span.unwrap_or_default(),
            format!("there is no {}, {why}", list.join(" or ")),
        )
        .about(Address::new(*first, 0))
        .with_help(format!(
            "write a section [{first:04X}], or mend the device type in 1000h"
        )),
    );
}

/// CiA 401: each of the four kinds of channels that 1000h announces.
fn io_module(description: &Description, device: DeviceType, findings: &mut Vec<Finding>) {
    for (bit, any_of, what) in [
        (
            0,
            &[0x6000, 0x6100, 0x6120][..],
            "but 1000h says digital inputs",
        ),
        (
            1,
            &[0x6200, 0x6300, 0x6320],
            "but 1000h says digital outputs",
        ),
        (
            2,
            &[0x6400, 0x6401, 0x6402, 0x6403, 0x6404],
            "but 1000h says analogue inputs",
        ),
        (
            3,
            &[0x6410, 0x6411, 0x6412, 0x6413, 0x6414],
            "but 1000h says analogue outputs",
        ),
    ] {
        if device.additional & 1 << bit != 0 {
            need(description, &rules::W0901, any_of, what, findings);
        }
    }
}

/// CiA 402: what every drive is controlled by. A device of several axes has them 800h apart.
fn drive(description: &Description, findings: &mut Vec<Finding>) {
    for (index, what) in [
        (0x6040, "the controlword of every drive"),
        (0x6041, "the statusword of every drive"),
        (0x6502, "which says the modes that a drive has"),
    ] {
        need(description, &rules::W0902, &[index], what, findings);
    }
}

/// CiA 404: the process values of the blocks that 1000h announces.
fn measuring(description: &Description, device: DeviceType, findings: &mut Vec<Finding>) {
    for (bit, any_of, what) in [
        (
            1,
            &[0x6130, 0x7130, 0x8130, 0x9130][..],
            "but 1000h says analogue inputs",
        ),
        (
            3,
            &[0x6300, 0x7300, 0x8300, 0x9300],
            "but 1000h says analogue outputs",
        ),
    ] {
        if device.additional & 1 << bit != 0 {
            need(description, &rules::W0903, any_of, what, findings);
        }
    }
}

/// The objects that there are have the code, types and access of the profile.
fn types(description: &Description, profile: u16, findings: &mut Vec<Finding>) {
    let (of_type, of_access) = match profile {
        406 => (&rules::W0950, &rules::W0951),
        _ => (&rules::W0905, &rules::W0906),
    };
    for (index, object) in description.objects.range(0x6000..=0x9FFF) {
        let Some(standard) = of(profile, *index) else {
            continue;
        };
        let Object {
            code,
            data_types,
            writable,
            ..
        } = *standard;
        if object.code.has_members() != code.has_members() {
            findings.push(
                of_type
                    .told(
                        place(&[object.code.span, object.span]),
                        format!(
                            "{index:04X}h is a {code} in CiA {profile}, and a {} here",
                            *object.code
                        ),
                    )
                    .about(Address::new(*index, 0))
                    .with_help(format!("write `ObjectType=0x{:X}`", code.code())),
            );
            continue;
        }
        let first = u8::from(code.has_members());
        for (sub, entry) in object.entries.range(first..=254) {
            let address = Address::new(*index, *sub);
            let shown = named(description, address);
            if let Some(given) = entry.data_type
                && let Some(right) = data_types.first()
                && !data_types.contains(&given)
            {
                findings.push(
                    of_type
                        .told(
                            place(&[given.span, entry.span]),
                            format!("{shown} is {right} in CiA {profile}, and {} here", *given),
                        )
                        .about(address)
                        .with_help(format!("write `DataType=0x{:04X}`", right.code()))
                        .fix(
                            Fix::unsafe_fix()
                                .replace(given.span, format!("0x{:04X}", right.code())),
                        ),
                );
            }
            if let Some(writable) = writable
                && entry.access.writable() != writable
            {
                let (right, word) = match writable {
                    true => ("can be written", "rw"),
                    false => ("is read only", "ro"),
                };
                findings.push(
                    of_access
                        .told(
                            place(&[entry.access.span, entry.span]),
                            format!(
                                "{shown} {right} in CiA {profile}, and is {} here",
                                *entry.access
                            ),
                        )
                        .about(address)
                        .with_help(format!("write `AccessType={word}`"))
                        .fix(Fix::unsafe_fix().replace(entry.access.span, word)),
                );
            }
        }
    }
}
