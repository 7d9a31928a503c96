//! The PDOs of a device as it has them now, and the SDO downloads that change a mapping.

use std::prelude::v1::*;

use od_model::typed::MapEntry;
use od_model::{Address, Entry};
use od_wire::AbortCode;
use od_wire::sdo::Request;
use od_wire::{CanId, CobId, Frame, NodeId};

use crate::device::VirtualDevice;

/// Bits of a PDO at most.
const MOST_BITS: u8 = 64;
/// The last PDO, counted from 0: CiA 301 has 512 in each direction.
const MOST: u16 = 0x1FF;

/// One PDO of a device.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Pdo {
    /// Index of its mapping parameter, 1600h to 17FFh or 1A00h to 1BFFh.
    pub mapping: u16,
    /// Index of its communication parameter, 1400h to 15FFh or 1800h to 19FFh.
    pub parameter: u16,
    /// A TPDO.
    pub transmits: bool,
    /// Number, from 1.
    pub number: u16,
    /// Value of its COB-ID object; `None` if the device has no such object, or no power.
    pub cob_id: Option<CobId>,
    /// Number of mapping entries for which there is room.
    pub room: u8,
    /// The mapping cannot be written.
    pub is_fixed: bool,
    /// The mapping, first entry first.
    pub entries: Vec<MapEntry>,
}

/// Direction of the PDO whose mapping parameter this is (`true`: TPDO) and its number from 1;
/// `None` for any other object.
pub const fn of_mapping(index: u16) -> Option<(bool, u16)> {
    match index {
        0x1600..=0x17FF => Some((false, index - 0x1600 + 1)),
        0x1A00..=0x1BFF => Some((true, index - 0x1A00 + 1)),
        _ => None,
    }
}

/// Returns whether an entry can be mapped into a TPDO, and whether into an RPDO.
pub fn fits(entry: &Entry) -> (bool, bool) {
    let bits = entry.data_type.bits().unwrap_or(0);
    let fits = entry.mappable && bits > 0 && bits <= MOST_BITS;
    let access = entry.access;
    (fits && access.maps_to_tpdo(), fits && access.maps_to_rpdo())
}

/// The PDOs of a device, TPDOs first.
pub fn pdos(device: &VirtualDevice) -> Vec<Pdo> {
    let dictionary = device.dictionary();
    let indices = || dictionary.objects().iter().map(|object| object.index);
    let tpdos = indices().filter(|index| *index >= 0x1800);
    let rpdos = indices().filter(|index| *index < 0x1800);
    tpdos
        .chain(rpdos)
        .filter_map(|index| pdo(device, index))
        .collect()
}

fn pdo(device: &VirtualDevice, mapping: u16) -> Option<Pdo> {
    let (transmits, number) = of_mapping(mapping)?;
    let parameter = communication(mapping);
    let dictionary = device.dictionary();
    let count = dictionary.entry(mapping, 0)?;
    let stored = |index, sub| {
        let value = device.is_powered().then(|| device.stored(index, sub));
        value.flatten().map(|value| value as u32)
    };
    let room = (1..=MOST_BITS).filter(|sub| dictionary.entry(mapping, *sub).is_some());
    Some(Pdo {
        mapping,
        parameter,
        transmits,
        number,
        cob_id: stored(parameter, 1).map(CobId::new),
        room: room.count() as u8,
        is_fixed: !count.access.writable(),
        entries: if device.is_powered() {
            entries(device, mapping)
        } else {
            Vec::new()
        },
    })
}

/// The objects of a mapping parameter as it is now, first entry first; empty without such a parameter.
pub(crate) fn entries(device: &VirtualDevice, mapping: u16) -> Vec<MapEntry> {
    let stored = |sub| device.stored(mapping, sub).unwrap_or(0);
    let count = stored(0).min(MOST_BITS.into()) as u8;
    (1..=count)
        .map(|sub| MapEntry::parse(stored(sub) as u32))
        .collect()
}

/// The mapping parameter of the valid PDO with this CAN-ID, TPDOs first.
pub(crate) fn with_can_id(device: &VirtualDevice, id: CanId) -> Option<u16> {
    for first in [0x1800, 0x1400] {
        let is_there = |index: &u16| device.dictionary().object(*index).is_some();
        let last = (first..=first + MOST).rev().find(is_there);
        for parameter in first..=last.unwrap_or(0) {
            let cob_id = device.stored(parameter, 1);
            let cob_id = cob_id.map(|raw| CobId::new(raw as u32));
            if cob_id.is_some_and(|cob_id| cob_id.is_valid() && cob_id.can_id() == id) {
                return Some(parameter + 0x200);
            }
        }
    }
    None
}

/// The parameter with the COB-ID of the PDO that a mapping parameter belongs to.
const fn communication(mapping: u16) -> u16 {
    mapping - 0x200
}

/// A part of the change of a mapping.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// Makes the PDO not valid.
    DisablePdo,
    /// Sets the number of mapped objects to 0.
    DisableMapping,
    /// Writes an entry.
    Entry,
    /// Sets the number of mapped objects.
    EnableMapping,
    /// Makes the PDO valid again.
    EnablePdo,
}

/// An SDO download of up to four bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Step {
    /// Service.
    pub part: Part,
    /// The object.
    pub address: Address,
    value: u32,
    size: u32,
}

impl Step {
    const fn new(part: Part, address: Address, value: u32, size: u32) -> Self {
        Self {
            part,
            address,
            value,
            size,
        }
    }

    /// The bytes to write.
    pub fn bytes(&self) -> Vec<u8> {
        self.value.to_le_bytes()[..self.size as usize].to_vec()
    }

    /// The frame that the SDO client sends.
    pub fn frame(&self, node: NodeId) -> Frame {
        let request = Request::InitiateDownload {
            address: self.address,
            size: Some(self.size),
            expedited: Some(self.value.to_le_bytes()),
        };
        Frame::full(node.plus(0x600), request.emit())
    }
}

/// The downloads that change a mapping (CiA 301, chapter 7.5.2.36). With a COB-ID they make the
/// PDO not valid first, and give it that COB-ID in the end.
pub fn steps(mapping: u16, entries: &[MapEntry], cob_id: Option<CobId>) -> Vec<Step> {
    const INVALID: u32 = 1 << 31;
    let count = |part, count| Step::new(part, Address::new(mapping, 0), count, 1);
    let id = |part, raw| Step::new(part, Address::new(communication(mapping), 1), raw, 4);
    let write = |(sub, entry): (u8, &MapEntry)| {
        Step::new(Part::Entry, Address::new(mapping, sub), entry.raw(), 4)
    };
    let mut steps = Vec::new();
    steps.extend(cob_id.map(|cob_id| id(Part::DisablePdo, cob_id.raw() | INVALID)));
    steps.push(count(Part::DisableMapping, 0));
    steps.extend((1..).zip(entries).map(write));
    steps.push(count(Part::EnableMapping, entries.len() as u32));
    steps.extend(cob_id.map(|cob_id| id(Part::EnablePdo, cob_id.raw())));
    steps
}

/// Returns whether a server aborts with this code because a mapping cannot be changed while its PDO is valid.
pub fn wants_pdo_disabled(code: u32) -> bool {
    matches!(
        AbortCode::from_code(code),
        Some(
            AbortCode::UnsupportedAccess
                | AbortCode::ReadOnly
                | AbortCode::ValueRange
                | AbortCode::NotStored
                | AbortCode::DeviceState
        )
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSITION: MapEntry = MapEntry {
        address: Address::new(0x6004, 0),
        bits: 32,
    };
    const SPEED: MapEntry = MapEntry {
        address: Address::new(0x6030, 1),
        bits: 16,
    };

    fn frames(steps: &[Step]) -> Vec<String> {
        let line = |step: &Step| step.frame(NodeId::ONE).to_string();
        steps.iter().map(line).collect()
    }

    #[test]
    fn a_mapping_is_disabled_while_it_changes() {
        let steps = steps(0x1A00, &[POSITION, SPEED], None);
        assert_eq!(
            frames(&steps),
            [
                "601#2F001A0000000000",
                "601#23001A0120000460",
                "601#23001A0210013060",
                "601#2F001A0002000000",
            ]
        );
        assert_eq!(steps[0].bytes(), [0]);
        assert_eq!(steps[1].bytes(), [0x20, 0, 4, 0x60]);
    }

    #[test]
    fn a_pdo_can_be_disabled_too() {
        let steps = steps(0x1A01, &[], Some(CobId::new(0x4000_0285)));
        let parts: Vec<_> = steps.iter().map(|step| step.part).collect();
        let wanted = [
            Part::DisablePdo,
            Part::DisableMapping,
            Part::EnableMapping,
            Part::EnablePdo,
        ];
        assert_eq!(parts, wanted);
        let frames = frames(&steps);
        assert_eq!(frames[0], "601#23011801850200C0");
        assert_eq!(frames[3], "601#2301180185020040");
    }

    #[test]
    fn mappings_have_a_direction_and_a_number() {
        assert_eq!(of_mapping(0x1A03), Some((true, 4)));
        assert_eq!(of_mapping(0x1600), Some((false, 1)));
        assert_eq!(of_mapping(0x1800), None);
    }
}
