//! Describes PDOs by the current mapping of the device.

use std::format;
use std::prelude::v1::*;

use od_client::pdo::decode;
use od_model::typed::MapEntry;
use od_model::{Address, values};
use od_runtime::Frame;

use super::description::{Service, Words, bytes};
use super::value::show_mapped;
use crate::device::{VirtualDevice, pdos};

/// Describes a frame whose CAN-ID belongs to a PDO of one of the devices.
pub(super) fn explain(devices: &[VirtualDevice], frame: &Frame) -> Option<Words> {
    let (device, mapping) = find(devices, frame)?;
    words(device, mapping, frame)
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
    let (device, mapping) = find(devices, frame)?;
    let mut first = 0;
    let place = |MapEntry { address, bits }| {
        first += u32::from(bits);
        (address, first - u32::from(bits), bits.into())
    };
    let parts = pdos::entries(device, mapping).into_iter().map(place);
    Some((device, parts.collect()))
}

/// The device of a PDO, and its mapping parameter.
fn find<'d>(devices: &'d [VirtualDevice], frame: &Frame) -> Option<(&'d VirtualDevice, u16)> {
    devices
        .iter()
        .find_map(|device| Some((device, pdos::with_can_id(device, frame.id())?)))
}

fn words(device: &VirtualDevice, mapping: u16, frame: &Frame) -> Option<Words> {
    let (transmits, number) = pdos::of_mapping(mapping)?;
    let (service, kind) = if transmits {
        (Service::Tpdo, "TPDO")
    } else {
        (Service::Rpdo, "RPDO")
    };
    let node = Some(device.node_id().raw());
    if frame.is_remote() {
        let text = format!("{kind}{number} requested (RTR)");
        return Some(Words::new(service, node, text));
    }
    let dictionary = device.dictionary();
    let entries = pdos::entries(device, mapping);
    let entries: Vec<u32> = entries.into_iter().map(MapEntry::raw).collect();
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
    Some(Words::new(service, node, text))
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
