//! Values of communication objects in words: mapping entries and COB-IDs, whose bits have meanings of their own.

use std::format;
use std::prelude::v1::*;

use od_model::{Address, DataType, values};
use od_wire::CobId;

use crate::device::VirtualDevice;

/// Shows the value of an object: `2118h, 16 bit` for a mapping entry, `181h, not valid` for a COB-ID, others by their
/// type, with what the number says in the documents of CiA: `1: profile position`.
pub(crate) fn show(
    device: &VirtualDevice,
    address: Address,
    data_type: DataType,
    data: &[u8],
) -> String {
    let raw = data.try_into().map(u32::from_le_bytes);
    if let Some(special) = raw.ok().and_then(|raw| meaning(address, raw)) {
        return special;
    }
    let shown = values::show(data_type, data);
    match documented(device, address, data_type, data) {
        Some(said) => format!("{shown}: {said}"),
        None => shown,
    }
}

/// Shows a value in a PDO, which has its first `bits` bits, like [`show`].
pub(super) fn show_mapped(
    device: &VirtualDevice,
    address: Address,
    data_type: DataType,
    data: &[u8],
    bits: u8,
) -> String {
    let shown = values::show_bits(data_type, data, bits);
    let is_whole = data_type.bits() == Some(bits);
    match documented(device, address, data_type, data).filter(|_| is_whole) {
        Some(said) => format!("{shown}: {said}"),
        None => shown,
    }
}

/// Meaning of a number in the documents of CiA; only with the tables of `od-eds`.
fn documented(
    device: &VirtualDevice,
    address: Address,
    data_type: DataType,
    data: &[u8],
) -> Option<String> {
    #[cfg(feature = "eds")]
    return od_eds::outline::meaning_of_bytes(device.dictionary(), address, data_type, data);
    #[cfg(not(feature = "eds"))]
    {
        let _ = (device, address, data_type, data);
        None
    }
}

/// The meaning of a value of four bytes (CiA 301, clause of the object); `None`: it is a number.
fn meaning(Address { index, sub }: Address, raw: u32) -> Option<String> {
    let cob_id = CobId::new(raw);
    let valid = if cob_id.is_valid() { "" } else { ", not valid" };
    let id = || match cob_id.can_id().as_standard() {
        Some(id) => format!("{id:03X}h"),
        None => format!("{:08X}h", cob_id.can_id().raw()),
    };
    Some(match (index, sub) {
        (0x1600..=0x17FF | 0x1A00..=0x1BFF, 1..=64) => entry(raw),
        (0x1400..=0x15FF, 1) | (0x1200..=0x12FF, 1 | 2) | (0x1014, 0) => format!("{}{valid}", id()),
        (0x1800..=0x19FF, 1) if cob_id.allows_rtr() => format!("{}{valid}", id()),
        (0x1800..=0x19FF, 1) => format!("{}{valid}, no RTR", id()),
        (0x1005, 0) if cob_id.produces_sync() => format!("{}, produces SYNC", id()),
        (0x1005, 0) => id(),
        (0x1012, 0) => {
            let consumes = if cob_id.consumes_time() {
                ", consumes TIME"
            } else {
                ""
            };
            let produces = if cob_id.produces_time() {
                ", produces TIME"
            } else {
                ""
            };
            format!("{}{consumes}{produces}", id())
        }
        (0x1016, 1..=127) => match (raw >> 16 & 0xFF, raw & 0xFFFF) {
            (0, _) | (_, 0) => format!("not used ({raw:08X}h)"),
            (node, time) => format!("node {node}, {time} ms"),
        },
        _ => return None,
    })
}

/// A mapping entry: index, sub-index and length in bits.
fn entry(raw: u32) -> String {
    let (index, sub, bits) = (raw >> 16, raw >> 8 & 0xFF, raw & 0xFF);
    match (raw, sub) {
        (0, _) => "no object (0)".into(),
        (_, 0) => format!("{index:04X}h, {bits} bit"),
        _ => format!("{index:04X}h:{sub:02X}, {bits} bit"),
    }
}

#[cfg(test)]
mod tests {
    use od_runtime::NodeId;

    use super::*;

    fn device(name: &str) -> VirtualDevice {
        let kind = od_devices::find(name).expect("a built-in device");
        VirtualDevice::new(kind, NodeId::ONE)
    }

    #[cfg(feature = "eds")]
    #[test]
    fn a_number_has_the_meaning_of_the_profile() {
        use DataType::{Integer8, Unsigned8, Unsigned16, Unsigned32};
        for (name, index, data_type, data, expected) in [
            ("drive", 0x6060, Integer8, &[1][..], "1: profile position"),
            (
                "drive",
                0x6060,
                Integer8,
                &[0xFF],
                "-1: mode of the manufacturer",
            ),
            ("drive", 0x6060, Integer8, &[5], "5"),
            (
                "drive",
                0x6041,
                Unsigned16,
                &[0x37, 2],
                "567 (237h): Operation enabled",
            ),
            (
                "drive",
                0x6502,
                Unsigned32,
                &[1, 0, 0, 0],
                "1: profile position",
            ),
            // Fewer bytes than the type has: no number.
            ("drive", 0x6041, Unsigned16, &[0x37], "37"),
            (
                "gxmm",
                0x1001,
                Unsigned8,
                &[0x11],
                "17 (11h): generic error, communication error",
            ),
            ("gxmm", 0x6060, Integer8, &[1], "1"),
        ] {
            let shown = show(&device(name), Address::new(index, 0), data_type, data);
            assert_eq!(shown, expected, "{name} {index:04X}h");
        }
    }

    #[test]
    fn mapping_entries_and_cob_ids_are_shown_as_what_they_are() {
        for (index, sub, raw, expected) in [
            (0x1A00, 2, 0x2118_0010, "2118h, 16 bit"),
            (0x1600, 1, 0x6200_0108, "6200h:01, 8 bit"),
            (0x1A00, 0, 2, "2"),
            (0x1A00, 1, 0, "no object (0)"),
            (0x1800, 1, 0x8000_0181, "181h, not valid"),
            (0x1800, 1, 0x4000_0181, "181h, no RTR"),
            (0x1801, 1, 0x281, "281h"),
            (0x1800, 5, 100, "100 (64h)"),
            (0x1400, 1, 0xA0FF_F201, "00FFF201h, not valid"),
            (0x1200, 1, 0x605, "605h"),
            (0x1014, 0, 0x8000_0081, "081h, not valid"),
            (0x1005, 0, 0x4000_0080, "080h, produces SYNC"),
            (0x1012, 0, 0x8000_0100, "100h, consumes TIME"),
            (0x1016, 1, 0x0005_03E8, "node 5, 1000 ms"),
            (0x1016, 2, 0, "not used (00000000h)"),
            (0x6004, 0, 0x181, "385 (181h)"),
        ] {
            let address = Address::new(index, sub);
            let bytes = u32::to_le_bytes(raw);
            let shown = show(&device("gxmm"), address, DataType::Unsigned32, &bytes);
            assert_eq!(shown, expected, "{address}");
        }
    }
}
