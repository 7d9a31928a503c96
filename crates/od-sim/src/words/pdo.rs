//! Describes PDOs by the current mapping of the device.

use std::format;
use std::prelude::v1::*;

use od_client::pdo::decode;
use od_model::typed::MapEntry;
use od_model::{Address, values};
use od_runtime::{CobId, Frame};

use super::description::{Service, Words, bytes};
use super::value::show_mapped;
use crate::device::VirtualDevice;

/// Limit of PDOs that are searched in a device's dictionary: 512.
const MOST: u16 = 0x1FF;

/// Describes a frame whose CAN-ID belongs to a PDO of one of the devices.
pub(super) fn explain(devices: &[VirtualDevice], frame: &Frame) -> Option<Words> {
    let (device, service, number, mapping) = find(devices, frame)?;
    Some(words(device, service, number, mapping, frame))
}

/// An object in the data of a PDO, its first bit and its number of bits.
pub(super) type Part = (Address, u32, u32);

/// Returns the objects in the data of a PDO by its current mapping, each with its first bit and its number
/// of bits. `None` for a frame that is not a PDO of these devices.
pub fn layout(devices: &[VirtualDevice], frame: &Frame) -> Option<Vec<Part>> {
    parts(devices, frame).map(|(_, parts)| parts)
}

/// The [`layout`] of a PDO, and its device.
pub(super) fn parts<'d>(
    devices: &'d [VirtualDevice],
    frame: &Frame,
) -> Option<(&'d VirtualDevice, Vec<Part>)> {
    let (device, _, _, index) = find(devices, frame)?;
    let mut first = 0;
    let place = |raw| {
        let MapEntry { address, bits } = MapEntry::parse(raw);
        first += u32::from(bits);
        (address, first - u32::from(bits), bits.into())
    };
    let parts = mapping(device, index).into_iter().map(place);
    Some((device, parts.collect()))
}

/// The current mapping entries of a mapping object.
fn mapping(device: &VirtualDevice, index: u16) -> Vec<u32> {
    let count = device.stored(index, 0).unwrap_or(0).min(64) as u8;
    let entry = |sub| device.stored(index, sub).unwrap_or(0) as u32;
    (1..=count).map(entry).collect()
}

/// The device of a PDO, its direction, its number from 0, and its mapping object.
fn find<'d>(
    devices: &'d [VirtualDevice],
    frame: &Frame,
) -> Option<(&'d VirtualDevice, Service, u16, u16)> {
    for device in devices {
        for (parameter, mapping, service) in [
            (0x1800, 0x1A00, Service::Tpdo),
            (0x1400, 0x1600, Service::Rpdo),
        ] {
            let last = (parameter..=parameter + MOST)
                .rev()
                .find(|index| device.dictionary().object(*index).is_some());
            for index in parameter..=last.unwrap_or(0) {
                let cob_id = device.stored(index, 1).map(|raw| CobId::new(raw as u32));
                if cob_id.is_some_and(|id| id.is_valid() && id.can_id() == frame.id()) {
                    let number = index - parameter;
                    return Some((device, service, number, mapping + number));
                }
            }
        }
    }
    None
}

fn words(
    device: &VirtualDevice,
    service: Service,
    number: u16,
    mapping_object: u16,
    frame: &Frame,
) -> Words {
    let kind = if service == Service::Tpdo {
        "TPDO"
    } else {
        "RPDO"
    };
    let node = Some(device.node_id().raw());
    let number = number + 1;
    if frame.is_remote() {
        return Words::new(service, node, format!("{kind}{number} requested (RTR)"));
    }
    let (dictionary, entries) = (device.dictionary(), mapping(device, mapping_object));
    // Of a PDO that is too short, show the values that it contains.
    let fields = (0..=entries.len())
        .rev()
        .find_map(|len| decode(&dictionary, &entries[..len], frame.data()).ok());
    let fields = fields.into_iter().flatten();
    let parts = fields.take_while(|field| !field.is_empty()).map(|field| {
        let bytes = &field.bytes()[..field.len()];
        let (name, shown) = match field.entry {
            Some(entry) => (
                values::name(dictionary, &entry),
                show_mapped(device, field.address, entry.data_type, bytes, field.bits),
            ),
            None => (field.address.to_string(), values::hex(bytes)),
        };
        format!("{name} = {shown}")
    });
    let parts: Vec<String> = parts.collect();
    // A value in words may contain a comma.
    let has_words = parts.iter().any(|part| part.contains(", "));
    let text = if parts.is_empty() {
        format!("{kind}{number} {}", bytes(frame.data().len()))
    } else {
        let between = if has_words { "; " } else { ", " };
        format!("{kind}{number} {}", parts.join(between))
    };
    Words::new(service, node, text)
}

/// Describes a frame of an unknown device by the predefined connection set.
pub(super) fn by_identifier(id: u16, frame: &Frame) -> Words {
    let node = (id & 0x7F) as u8;
    let number = (id >> 7) - 3;
    let (service, kind) = match number % 2 {
        0 => (Service::Tpdo, "TPDO"),
        _ => (Service::Rpdo, "RPDO"),
    };
    let number = number / 2 + 1;
    let text = if frame.is_remote() {
        format!("{kind}{number} requested (RTR)")
    } else {
        format!("{kind}{number} {}", bytes(frame.data().len()))
    };
    Words::new(service, (node != 0).then_some(node), text)
}
