//! The COB-IDs of a description, and their meaning (CiA 301, chapter 7.5.2).

use od_eds::{Description, Value};
use od_model::Address;

/// Returns whether the value at this address is a COB-ID.
pub(crate) const fn is_one(address: Address) -> bool {
    match address.index {
        0x1005 | 0x1012 | 0x1014 => address.sub == 0,
        0x1028 => address.sub > 0,
        0x1200..=0x12FF => matches!(address.sub, 1 | 2),
        0x1400..=0x15FF | 0x1800..=0x19FF => address.sub == 1,
        _ => false,
    }
}

/// A COB-ID without its flags.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct CobId {
    can_id: u32,
    /// Whether the node ID is added.
    node_id: bool,
    /// Bit 31.
    invalid: bool,
    /// Bit 30: a producer of SYNC or TIME, or no RTR of a TPDO; an RPDO does not use it.
    bit_30: bool,
    extended: bool,
}

impl CobId {
    /// Reads the COB-ID of a value.
    pub(crate) fn of(value: &Value) -> Option<Self> {
        let (number, node_id) = match value {
            Value::NodeId(offset) => (*offset, true),
            Value::Unsigned(number) => (u32::try_from(*number).ok()?, false),
            _ => return None,
        };
        Some(Self {
            can_id: number & 0x1FFF_FFFF,
            node_id,
            invalid: number & 1 << 31 != 0,
            bit_30: number & 1 << 30 != 0,
            extended: number & 1 << 29 != 0,
        })
    }

    /// Returns whether two have the same CAN-ID if their node IDs are equal.
    pub(crate) fn is_like(self, other: Self) -> bool {
        (self.can_id, self.node_id, self.extended) == (other.can_id, other.node_id, other.extended)
    }

    /// The CAN-ID of a node; `None` if it does not depend on the node ID.
    pub(crate) fn of_node(self, node: u8) -> Option<u32> {
        self.node_id.then(|| self.can_id + u32::from(node))
    }

    /// The COB-ID in words: `180h + node ID`.
    pub(crate) fn words(self, address: Address) -> String {
        let mut words = if self.node_id {
            format!("{:X}h + node ID", self.can_id)
        } else {
            format!("{:X}h", self.can_id)
        };
        if self.extended {
            words.push_str(", 29 bits");
        }
        words.push_str(match (address.index, self.invalid) {
            (0x1005, _) | (_, false) => "",
            (0x1012, true) => ", TIME consumer",
            (_, true) => ", not valid",
        });
        words.push_str(match (address.index, self.bit_30) {
            (0x1005, true) => ", SYNC producer",
            (0x1012, true) => ", TIME producer",
            (0x1800..=0x19FF, true) => ", no RTR",
            _ => "",
        });
        words
    }
}

/// All COB-IDs of a description, with their addresses and their spans in the text.
pub(crate) fn all(
    description: &Description,
) -> impl Iterator<Item = (Address, CobId, std::ops::Range<usize>)> + '_ {
    let entries = description
        .entries()
        .filter(|(address, _)| is_one(*address));
    entries.flat_map(|(address, entry)| {
        let values = [&entry.default, &entry.parameter].into_iter().flatten();
        values.filter_map(move |value| {
            let own = value.span.line != 0;
            let id = CobId::of(&value.value).filter(|_| own)?;
            Some((address, id, crate::layout::bytes(value.span)))
        })
    })
}

/// The mapping object of the communication parameter of a PDO.
pub(crate) const fn mapping_of(index: u16) -> Option<u16> {
    match index {
        0x1400..=0x15FF | 0x1800..=0x19FF => Some(index + 0x200),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_have_the_meaning_of_their_object() {
        for (index, sub, number, expected) in [
            (0x1005, 0, 0x4000_0080, "80h, SYNC producer"),
            (0x1005, 0, 0x8000_0080, "80h"),
            (0x1012, 0, 0x8000_0100, "100h, TIME consumer"),
            (0x1012, 0, 0xC000_0100, "100h, TIME consumer, TIME producer"),
            (0x1014, 0, 0x8000_0081, "81h, not valid"),
            (0x1800, 1, 0xC000_0181, "181h, not valid, no RTR"),
            (0x1800, 1, 0x6001_2345, "12345h, 29 bits, no RTR"),
            // An RPDO does not use bit 30.
            (0x1400, 1, 0x4000_0201, "201h"),
        ] {
            let id = CobId::of(&Value::Unsigned(number)).unwrap();
            let found = id.words(Address::new(index, sub));
            assert_eq!(found, expected, "{index:04X}h:{sub:02X} = {number:X}h");
        }
    }
}
