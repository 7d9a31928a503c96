//! CiA 406: the objects of an absolute encoder, and what its PDOs carry.
//!
//! Guarantees that a master finds the position, its resolution and what the device can signal.
//! Assumes that types and access are looked at with those of the other profiles.
//! Source: CiA 406, object overview and encoder classes.

use alloc::format;
use alloc::vec::Vec;

use super::{DeviceType, encoder_values, need};
use crate::check::{place, start_number};
use crate::description::Description;
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use od_model::Address;

/// Where an encoder has its position.
const POSITIONS: [u16; 4] = [0x6004, 0x6008, 0x6020, 0x6050];

pub(super) fn check(description: &Description, device: DeviceType, findings: &mut Vec<Finding>) {
    mandatory(description, device, findings);
    mappable(description, findings);
    mapped(description, findings);
    cams(description, findings);
    encoder_values::check(description, device, findings);
}

fn mandatory(description: &Description, device: DeviceType, findings: &mut Vec<Finding>) {
    let mut object = |any_of: &[u16], why: &str| {
        need(description, &rules::W0904, any_of, why, findings);
    };
    object(&[0x6000], "which says how the encoder counts");
    object(&POSITIONS, "where the position stands");
    object(&[0x6500], "which shows how the encoder counts");
    object(&[0x6501], "which says the resolution");
    if revolutions(device).is_some_and(|many| many) {
        object(&[0x6502], "which says how many revolutions there are");
    }
    object(&[0x6503], "by which an encoder tells its alarms");
    object(&[0x6504], "which says the alarms that there are");
    object(&[0x6505], "by which an encoder tells its warnings");
    object(&[0x6506], "which says the warnings that there are");
    object(&[0x6507], "which says the versions of profile and software");
    object(&[0x6509], "which says the offset that a preset made");
    // Scaling is for class 2; who has half of it has it all.
    let scaling = [0x6001, 0x6002];
    if scaling
        .iter()
        .any(|index| description.objects.contains_key(index))
    {
        for index in scaling {
            need(
                description,
                &rules::W0904,
                &[index],
                "without which an encoder cannot be scaled",
                findings,
            );
        }
    }
}

/// Does the encoder count revolutions? `None` for linear and unknown ones.
pub(super) fn revolutions(device: DeviceType) -> Option<bool> {
    match device.additional {
        1 => Some(false),
        2 => Some(true),
        _ => None,
    }
}

/// The position, alarms and warnings are what PDOs are for.
fn mappable(description: &Description, findings: &mut Vec<Finding>) {
    for index in [0x6004, 0x6008] {
        let address = Address::new(index, 0);
        let Some(entry) = description.entry(address).filter(|entry| !*entry.mappable) else {
            continue;
        };
        findings.push(
            rules::W0953
                .told(
                    place(&[entry.mappable.span, entry.span]),
                    format!("{index:04X}h is the position, and no PDO may carry it"),
                )
                .about(address)
                .with_help("write `PDOMapping=1`")
                .fix(match entry.mappable.span.line {
                    0 => Fix::unsafe_fix().below(entry.span, "PDOMapping=1"),
                    _ => Fix::unsafe_fix().replace(entry.mappable.span, "1"),
                }),
        );
    }
}

/// One of the TPDOs carries the position as the device is shipped.
fn mapped(description: &Description, findings: &mut Vec<Finding>) {
    let mut mappings = description.objects.range(0x1A00..=0x1BFF).peekable();
    let Some((first, object)) = mappings.peek().copied() else {
        return;
    };
    let carries = mappings.any(|(index, object)| {
        object.entries.range(1..=64).any(|(sub, _)| {
            let target = start_number(description, Address::new(*index, *sub));
            let target = target.map(|target| (target.value >> 16) as u16);
            target.is_some_and(|target| POSITIONS.contains(&target) || target == 0x600C)
        })
    });
    if !carries {
        findings.push(
            rules::W0963
                .told(object.span, "no TPDO carries the position")
                .about(Address::new(*first, 0))
                .with_help("map 6004h: write `DefaultValue=0x60040020` in [1A00sub1]"),
        );
    }
}

/// A cam channel has its state, its switch, its polarity, two limits and a hysteresis.
fn cams(description: &Description, findings: &mut Vec<Finding>) {
    let Some((first, object)) = description.objects.range(0x6300..=0x63FF).next() else {
        return;
    };
    for (index, what) in [
        (0x6300, "state"),
        (0x6301, "enable"),
        (0x6302, "polarity"),
        (0x6310, "low limit"),
        (0x6320, "high limit"),
        (0x6330, "hysteresis"),
    ] {
        if !description.objects.contains_key(&index) {
            findings.push(
                rules::W0960
                    .told(
                        object.span,
                        format!("there are cams ({first:04X}h), but no {index:04X}h (CAM {what})"),
                    )
                    .about(Address::new(index, 0))
                    .with_help(format!("write a section [{index:04X}]")),
            );
        }
    }
}
