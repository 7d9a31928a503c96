//! A value of a dictionary as 16 bytes of flash, and back.
//!
//! | word | bits | content |
//! |--:|--:|---|
//! | 0 | 8–31 | address: index, sub-index |
//! | | 3–7 | data type, its position in [`DataType::ALL`] |
//! | | 0–2 | [kind](literal) of the default |
//! | 1 | | offset in the store |
//! | 2 | | default; for a wide one or a string its position in the pool |
//! | 3 | 0–3 | length, if a master may read the value, the value is in the store, and its type
//! gives its length |
//! | | 4–6, 7, 8–9 | access, PDO mapping, group |
//! | | 10–12 | code of the object |
//! | | 13 | the value is in the store |
//! | | 14–31 | 1 plus the position of the limits in the pool; 0: no limits |
//!
//! The pool consists of words. A wide literal has its low and its high half there. A string has the
//! start and length of its default, and the length of its slot. Limits have both kinds, and then
//! their words.

use crate::access::{Access, Group};
use crate::address::Address;
use crate::entry::{Entry, Slot};
use crate::types::{DataType, Kind, ObjectCode};
use crate::value::{Literal, Range};

/// A value of a dictionary, packed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Row(pub [u32; 4]);

/// First kind of which a literal has two words.
const WIDE: u32 = 4;
/// Index of the pre-defined error field.
const LOG: u16 = 0x1003;
/// Kind of a string.
const RANGE: u32 = 7;

/// Object codes by their number in a row.
const CODES: [ObjectCode; 7] = [
    ObjectCode::Null,
    ObjectCode::Domain,
    ObjectCode::DefType,
    ObjectCode::DefStruct,
    ObjectCode::Var,
    ObjectCode::Array,
    ObjectCode::Record,
];

/// Kind of a literal, and its bits: 1 UNSIGNED and 2 INTEGER of 32 bits, 3 `$NODEID`, 4 and 5 of 64,
/// 6 REAL, 7 string. Kinds of one word have 32 bits.
pub const fn literal(literal: Literal) -> (u32, u64) {
    match literal {
        Literal::None => (0, 0),
        Literal::Unsigned(v) if v <= u32::MAX as u64 => (1, v),
        Literal::Signed(v) if v as i32 as i64 == v => (2, v as u32 as u64),
        Literal::NodeId(v) => (3, v as u64),
        Literal::Unsigned(v) => (4, v),
        Literal::Signed(v) => (5, v as u64),
        Literal::Real(v) => (6, v.to_bits()),
        Literal::Text(range) | Literal::Bytes(range) => {
            (RANGE, (range.len as u64) << 32 | range.start as u64)
        }
    }
}

/// Number of words of a literal: 0 to 2.
pub const fn words(kind: u32) -> usize {
    match kind {
        0 => 0,
        1..WIDE => 1,
        _ => 2,
    }
}

/// The literal of a kind and its bits, for a value of this type.
const fn unpack(kind: u32, bits: u64, is_text: bool) -> Literal {
    let low = bits as u32;
    match kind {
        1 => Literal::Unsigned(low as u64),
        2 => Literal::Signed(low as i32 as i64),
        3 => Literal::NodeId(low),
        4 => Literal::Unsigned(bits),
        5 => Literal::Signed(bits as i64),
        6 => Literal::Real(f64::from_bits(bits)),
        RANGE => {
            let range = Range::new(low, (bits >> 32) as u32);
            if is_text {
                Literal::Text(range)
            } else {
                Literal::Bytes(range)
            }
        }
        _ => Literal::None,
    }
}

const fn word(pool: &[u32], at: usize) -> u32 {
    if at < pool.len() { pool[at] } else { 0 }
}

/// The bits of a literal in the pool.
const fn bits(pool: &[u32], at: usize, kind: u32) -> u64 {
    let high = if words(kind) > 1 {
        word(pool, at + 1)
    } else {
        0
    };
    (high as u64) << 32 | word(pool, at) as u64
}

/// The bits of a literal of two words in the pool.
const fn wide(pool: &[u32], at: usize) -> u64 {
    bits(pool, at, WIDE)
}

/// The bits of a number of up to two words.
const fn number(kind: u32, bits: u64, node_id: u8) -> u64 {
    match kind {
        2 => bits as i32 as u64,
        3 => bits + node_id as u64,
        _ => bits,
    }
}

/// Length of a value in bytes, by the first word of its row.
const fn size(head: u32) -> usize {
    (BITS[(head >> 3 & 31) as usize] as usize).div_ceil(8)
}

/// Length of each data type in bits, 0 if it varies, in the order of [`DataType::ALL`]. The table
/// has an element for every number that a row can contain.
static BITS: [u8; 32] = {
    let mut bits = [0; 32];
    let mut i = 0;
    while i < DataType::ALL.len() {
        if let Some(number) = DataType::ALL[i].bits() {
            bits[i] = number;
        }
        i += 1;
    }
    bits
};

/// Kind of each data type, with an element for every number that a row can contain.
static KINDS: [Kind; 32] = {
    let mut kinds = [Kind::Unsigned; 32];
    let mut i = 0;
    while i < DataType::ALL.len() {
        kinds[i] = DataType::ALL[i].kind();
        i += 1;
    }
    kinds
};

impl Row {
    /// Row of an entry of an object with this code. `default` is its bits, or their position in the
    /// pool; `limits` has the form of the row.
    pub const fn new(entry: &Entry, code: ObjectCode, default: u32, limits: u32) -> Self {
        let mut data_type = 0;
        while DataType::ALL[data_type as usize] as u16 != entry.data_type as u16 {
            data_type += 1;
        }
        let mut number = 0;
        while CODES[number as usize] as u8 != code as u8 {
            number += 1;
        }
        let is_stored = entry.slot.len > 0;
        let plain = match entry.data_type.size() {
            _ if entry.address.index == LOG => 0,
            Some(size) if is_stored && entry.access.readable() => size as u32,
            _ => 0,
        };
        let (kind, _) = literal(entry.default);
        Self([
            entry.address.key() << 8 | data_type << 3 | kind,
            entry.slot.offset,
            default,
            plain
                | (entry.access as u32) << 4
                | (entry.mappable as u32) << 7
                | (entry.group as u32) << 8
                | number << 10
                | (is_stored as u32) << 13
                | limits << 14,
        ])
    }

    /// All words as one number, the first one lowest. The macro writes a row in this form.
    pub const fn number(self) -> u128 {
        let [a, b, c, d] = self.0;
        a as u128 | (b as u128) << 32 | (c as u128) << 64 | (d as u128) << 96
    }

    /// The address as one number.
    pub const fn key(self) -> u32 {
        self.0[0] >> 8
    }

    /// Index and sub-index.
    pub const fn address(self) -> Address {
        Address::new(self.index(), (self.0[0] >> 8) as u8)
    }

    /// Returns whether a master may read the value.
    pub const fn readable(self) -> bool {
        self.0[3] >> 4 & 7 != Access::Wo as u32
    }

    /// Returns whether a master may write the value.
    pub const fn writable(self) -> bool {
        self.has_access(1 << Access::Wo as u32 | 1 << Access::Rw as u32)
            || self.has_access(1 << Access::Rwr as u32 | 1 << Access::Rww as u32)
    }

    /// Returns whether the bit of the access is set in `of`.
    const fn has_access(self, of: u32) -> bool {
        of >> (self.0[3] >> 4 & 7) & 1 != 0
    }

    /// Returns whether the value is never written.
    pub const fn is_const(self) -> bool {
        self.has_access(1 << Access::Const as u32)
    }

    /// Returns whether the value may be mapped into a TPDO, as [`Entry::maps_to_tpdo`].
    pub const fn maps_to_tpdo(self) -> bool {
        self.0[3] & 1 << 7 != 0
            && !self.has_access(1 << Access::Wo as u32 | 1 << Access::Rww as u32)
    }

    /// Returns whether the value may be mapped into an RPDO, as [`Entry::maps_to_rpdo`].
    pub const fn maps_to_rpdo(self) -> bool {
        let of = 1 << Access::Wo as u32 | 1 << Access::Rw as u32 | 1 << Access::Rww as u32;
        self.0[3] & 1 << 7 != 0 && self.has_access(of)
    }

    /// The sub-index of 1010h that saves the value.
    pub const fn group(self) -> Group {
        match self.0[3] >> 8 & 3 {
            0 => Group::None,
            1 => Group::Communication,
            2 => Group::Application,
            _ => Group::Manufacturer,
        }
    }

    /// Returns whether the store has the value.
    pub const fn is_stored(self) -> bool {
        self.0[3] & 1 << 13 != 0
    }

    /// Data type.
    pub const fn data_type(self) -> DataType {
        let number = (self.0[0] >> 3 & 31) as usize;
        if number < DataType::ALL.len() {
            DataType::ALL[number]
        } else {
            DataType::Unsigned8
        }
    }

    /// Meaning of the bytes, as [`DataType::kind`](crate::DataType::kind) returns it.
    pub const fn kind(self) -> Kind {
        KINDS[(self.0[0] >> 3 & 31) as usize]
    }

    /// Length of a value whose type gives it, in bits; 0 for a string or DOMAIN.
    pub const fn bits(self) -> u8 {
        BITS[(self.0[0] >> 3 & 31) as usize]
    }

    /// Length of a value whose type gives it, in bytes; 0 for a string or DOMAIN.
    pub const fn size(self) -> usize {
        size(self.0[0])
    }

    /// Returns whether the length varies (strings, domains) instead of following from the type.
    pub const fn is_variable(self) -> bool {
        size(self.0[0]) == 0
    }

    /// Returns whether the description gives an integer as the default, with or without `$NODEID`.
    pub const fn has_integer_default(self) -> bool {
        matches!(self.0[0] & 7, 1..=5)
    }

    /// Returns whether the default is `$NODEID` plus a number.
    pub const fn follows_node_id(self) -> bool {
        self.0[0] & 7 == 3
    }

    /// Place in the store of a value whose type gives its length; length 0 if it has no place.
    pub const fn fixed_slot(self) -> Slot {
        let len = if self.is_stored() {
            self.size() as u16
        } else {
            0
        };
        let offset = self.0[1];
        Slot { offset, len }
    }

    /// Place of the value in the store.
    pub const fn slot(self, pool: &[u32]) -> Slot {
        let len = match self.size() {
            _ if !self.is_stored() => 0,
            0 => word(pool, self.0[2] as usize + 2) as u16,
            size => size as u16,
        };
        let offset = self.0[1];
        Slot { offset, len }
    }

    /// The default of a number: its bits; for a REAL those of an IEEE 754 double. 0 without a
    /// default.
    pub const fn default(self, pool: &[u32], node_id: u8) -> u64 {
        let (kind, at) = (self.0[0] & 7, self.0[2]);
        if kind < WIDE {
            number(kind, at as u64, node_id)
        } else {
            wide(pool, at as usize)
        }
    }

    /// Range of the default of a string in its arena.
    pub const fn range(self, pool: &[u32]) -> Range {
        match self.0[0] & 7 {
            RANGE => {
                let bits = bits(pool, self.0[2] as usize, RANGE);
                Range::new(bits as u32, (bits >> 32) as u32)
            }
            _ => Range::new(0, 0),
        }
    }

    /// Index of the object.
    pub const fn index(self) -> u16 {
        (self.0[0] >> 16) as u16
    }

    /// Code of the object.
    pub const fn code(self) -> ObjectCode {
        let number = (self.0[3] >> 10 & 7) as usize;
        if number < CODES.len() {
            CODES[number]
        } else {
            ObjectCode::Var
        }
    }

    /// Slot of a value that a master may read at any time and whose type gives its length; length 0
    /// for any other value, and for the error history (1003h), whose length changes.
    pub const fn plain(self) -> Slot {
        Slot {
            offset: self.0[1],
            len: (self.0[3] & 15) as u16,
        }
    }

    /// The entry, without its name, which the row does not contain.
    pub const fn entry(self, pool: &[u32]) -> Entry {
        let [head, _, payload, flags] = self.0;
        let is_text = self.data_type() as u16 == DataType::VisibleString as u16;
        let (kind, at) = (head & 7, payload as usize);
        let default = if kind < WIDE {
            payload as u64
        } else {
            bits(pool, at, kind)
        };
        let (mut low, mut high) = (Literal::None, Literal::None);
        let limits = (flags >> 14) as usize;
        if limits > 0 {
            let kinds = word(pool, limits - 1);
            low = unpack(kinds & 7, bits(pool, limits, kinds & 7), is_text);
            let at = limits + words(kinds & 7);
            high = unpack(kinds >> 3, bits(pool, at, kinds >> 3), is_text);
        }
        Entry {
            address: self.address(),
            data_type: self.data_type(),
            access: match flags >> 4 & 7 {
                0 => Access::Ro,
                1 => Access::Wo,
                2 => Access::Rw,
                3 => Access::Rwr,
                4 => Access::Rww,
                _ => Access::Const,
            },
            mappable: flags & 1 << 7 != 0,
            group: self.group(),
            name: Range::new(0, 0),
            default: unpack(kind, default, is_text),
            low,
            high,
            slot: self.slot(pool),
        }
    }

    /// Returns whether the value has limits besides those of its type.
    pub const fn has_limits(self) -> bool {
        self.0[3] >> 14 != 0
    }

    /// Lower or upper limit in the form of [`default`](Self::default); `None` if only the type limits the value.
    pub const fn limit(&self, is_upper: bool, pool: &[u32], node_id: u8) -> Option<u64> {
        let mut at = (self.0[3] >> 14) as usize;
        if at == 0 {
            return None;
        }
        let mut kind = word(pool, at - 1);
        if is_upper {
            at += words(kind & 7);
            kind >>= 3;
        }
        match kind & 7 {
            0 | RANGE => None,
            kind => Some(number(kind, bits(pool, at, kind), node_id)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row has its own masks of access types, which need no `Access`.
    #[test]
    fn a_row_and_its_entry_allow_the_same() {
        for access in Access::ALL {
            for mappable in [false, true] {
                let entry = Entry {
                    address: Address::new(0x2000, 0),
                    data_type: DataType::Unsigned16,
                    access,
                    mappable,
                    group: Group::None,
                    name: Range::new(0, 0),
                    default: Literal::None,
                    low: Literal::None,
                    high: Literal::None,
                    slot: Slot { offset: 0, len: 2 },
                };
                let row = Row::new(&entry, ObjectCode::Var, 0, 0);
                assert_eq!(row.entry(&[]), entry);
                assert_eq!(row.readable(), access.readable(), "{access}");
                assert_eq!(row.writable(), access.writable(), "{access}");
                assert_eq!(row.is_const(), access == Access::Const);
                assert_eq!(row.maps_to_tpdo(), entry.maps_to_tpdo(), "{access}");
                assert_eq!(row.maps_to_rpdo(), entry.maps_to_rpdo(), "{access}");
            }
        }
    }
}
