//! PDO mapping entries (CiA 301, objects 1600h–17FFh and 1A00h–1BFFh).

use od_model::Address;

/// What a mapping entry says: index, sub-index, length in bits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct MapRepr {
    /// What is mapped.
    pub address: Address,
    /// How many bits.
    pub bits: u8,
}

impl MapRepr {
    /// The meaning of a mapping entry; every number has one.
    pub const fn parse(raw: u32) -> Self {
        let [bits, sub, low, high] = raw.to_le_bytes();
        Self {
            address: Address::new(u16::from_le_bytes([low, high]), sub),
            bits,
        }
    }

    /// The mapping entry.
    pub const fn emit(self) -> u32 {
        (self.address.index as u32) << 16 | (self.address.sub as u32) << 8 | self.bits as u32
    }
}
