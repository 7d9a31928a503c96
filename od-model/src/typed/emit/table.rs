//! The tables of a compiled dictionary, as they come out of the macro: rows of bytes.
//!
//! A literal of bytes is one token, however many rows it has, and a `const fn` that
//! turns it into a table is compiled once. An expression for each row costs the compiler
//! ten times as much, and an IDE keeps each of its tokens.

use crate::access::{Access, Group};
use crate::address::Address;
use crate::entry::Slot;
use crate::types::{DataType, ObjectCode};
use crate::value::{Literal, Range};

pub use crate::dictionary::Dictionary;
pub use crate::entry::{Entry, Object};
pub use crate::index::{Place, bucket_count, buckets, places};

/// Without the checks of [`Dictionary::new`], which thousands of entries would
/// wait for: the macro takes its tables out of `od_eds::Tables`.
pub const fn dictionary(
    buckets: &'static [u16],
    places: &'static [Place],
    objects: &'static [Object],
    entries: &'static [Entry],
    text: &'static str,
    blob: &'static [u8],
    store_len: usize,
) -> Dictionary<'static> {
    Dictionary::trusted(buckets, places, objects, entries, text, blob, store_len)
}

/// Bytes of an object's row.
const OBJECT: usize = 17;
/// Bytes of an entry's row.
const ENTRY: usize = 46;

/// A number of its bytes, little-endian. Not `from_le_bytes`: the compiler runs this for
/// every row of every dictionary, and there a call costs as much as twenty operators.
macro_rules! number {
    ($type:ty: $low:ident $($byte:ident $shift:literal)*) => {
        $low as $type $(| ($byte as $type) << $shift)*
    };
}

/// A literal of its kind and number.
macro_rules! literal {
    ($kind:ident: $a:ident $b:ident $c:ident $d:ident $e:ident $f:ident $g:ident $h:ident) => {
        if $kind == 0 {
            Literal::None
        } else {
            let start = number!(u32: $e $f 8 $g 16 $h 24);
            let len = number!(u32: $a $b 8 $c 16 $d 24);
            let range = Range { start, len };
            let number = (start as u64) << 32 | len as u64;
            match $kind {
                1 => Literal::Unsigned(number),
                2 => Literal::Signed(number as i64),
                3 => Literal::Real(f64::from_bits(number)),
                4 => Literal::NodeId(len),
                5 => Literal::Text(range),
                _ => Literal::Bytes(range),
            }
        }
    };
}

/// The row of an object.
#[rustfmt::skip] // a row is a row
pub const fn object_row(object: &Object) -> [u8; OBJECT] {
    let [a, b] = object.index.to_le_bytes();
    let [c, d, e, f] = object.name.start.to_le_bytes();
    let [g, h, i, j] = object.name.len.to_le_bytes();
    let [k, l, m, n] = object.first.to_le_bytes();
    let [o, p] = object.count.to_le_bytes();
    [a, b, object.code.code(), c, d, e, f, g, h, i, j, k, l, m, n, o, p]
}

/// The objects of these rows.
///
/// # Panics
/// If there are not `N` of them. In a `const` that is a compile error.
#[rustfmt::skip]
pub const fn objects<const N: usize>(rows: &[u8]) -> [Object; N] {
    let rows = rows.as_chunks::<OBJECT>().0;
    assert!(rows.len() == N, "a row an object");
    let name = Range { start: 0, len: 0 };
    let mut objects = [Object { index: 0, code: ObjectCode::Var, name, first: 0, count: 0 }; N];
    let mut at = 0;
    while at < N {
        let [a, b, code, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = rows[at];
        objects[at] = Object {
            index: number!(u16: a b 8),
            code: match ObjectCode::from_code(code) {
                Some(code) => code,
                None => panic!("an object code"),
            },
            name: Range { start: number!(u32: c d 8 e 16 f 24), len: number!(u32: g h 8 i 16 j 24) },
            first: number!(u32: k l 8 m 16 n 24),
            count: number!(u16: o p 8),
        };
        at += 1;
    }
    objects
}

/// The row of an entry.
#[rustfmt::skip]
pub const fn entry_row(entry: &Entry) -> [u8; ENTRY] {
    let mut data_type = 0;
    while DataType::ALL[data_type as usize] as u16 != entry.data_type as u16 {
        data_type += 1;
    }
    let [a, b] = entry.address.index.to_le_bytes();
    let sub = entry.address.sub;
    let flags = entry.access as u8 | (entry.mappable as u8) << 3 | (entry.group as u8) << 4;
    let [c, d, e, f] = entry.name.start.to_le_bytes();
    let [g, h, i, j] = entry.name.len.to_le_bytes();
    let (default, [x0, x1, x2, x3, x4, x5, x6, x7]) = literal_row(entry.default);
    let (low, [y0, y1, y2, y3, y4, y5, y6, y7]) = literal_row(entry.low);
    let (high, [z0, z1, z2, z3, z4, z5, z6, z7]) = literal_row(entry.high);
    let [k, l, m, n] = entry.slot.offset.to_le_bytes();
    let [o, p] = entry.slot.len.to_le_bytes();
    [
        a, b, sub, data_type, flags, default, low, high, c, d, e, f, g, h, i, j,
        x0, x1, x2, x3, x4, x5, x6, x7, y0, y1, y2, y3, y4, y5, y6, y7,
        z0, z1, z2, z3, z4, z5, z6, z7, k, l, m, n, o, p,
    ]
}

/// A literal's kind, and its number.
const fn literal_row(literal: Literal) -> (u8, [u8; 8]) {
    let (kind, number) = match literal {
        Literal::None => (0, 0),
        Literal::Unsigned(v) => (1, v),
        Literal::Signed(v) => (2, v as u64),
        Literal::Real(v) => (3, v.to_bits()),
        Literal::NodeId(v) => (4, v as u64),
        Literal::Text(range) => (5, (range.start as u64) << 32 | range.len as u64),
        Literal::Bytes(range) => (6, (range.start as u64) << 32 | range.len as u64),
    };
    (kind, number.to_le_bytes())
}

/// The entries of these rows.
///
/// # Panics
/// If there are not `N` of them. In a `const` that is a compile error.
#[rustfmt::skip]
pub const fn entries<const N: usize>(rows: &[u8]) -> [Entry; N] {
    let rows = rows.as_chunks::<ENTRY>().0;
    assert!(rows.len() == N, "a row an entry");
    let types = &DataType::ALL;
    let mut entries = [NOTHING; N];
    let mut at = 0;
    while at < N {
        let [
            a, b, sub, data_type, flags, default, low, high, c, d, e, f, g, h, i, j,
            x0, x1, x2, x3, x4, x5, x6, x7, y0, y1, y2, y3, y4, y5, y6, y7,
            z0, z1, z2, z3, z4, z5, z6, z7, k, l, m, n, o, p,
        ] = rows[at];
        entries[at] = Entry {
            address: Address { index: number!(u16: a b 8), sub },
            data_type: types[data_type as usize],
            access: match flags & 7 {
                0 => Access::Ro,
                1 => Access::Wo,
                2 => Access::Rw,
                3 => Access::Rwr,
                4 => Access::Rww,
                _ => Access::Const,
            },
            mappable: flags & 8 != 0,
            group: match flags & 0x30 {
                0x00 => Group::None,
                0x10 => Group::Communication,
                0x20 => Group::Application,
                _ => Group::Manufacturer,
            },
            name: Range { start: number!(u32: c d 8 e 16 f 24), len: number!(u32: g h 8 i 16 j 24) },
            default: literal!(default: x0 x1 x2 x3 x4 x5 x6 x7),
            low: literal!(low: y0 y1 y2 y3 y4 y5 y6 y7),
            high: literal!(high: z0 z1 z2 z3 z4 z5 z6 z7),
            slot: Slot { offset: number!(u32: k l 8 m 16 n 24), len: number!(u16: o p 8) },
        };
        at += 1;
    }
    entries
}

/// Initial content of a table.
const NOTHING: Entry = Entry {
    address: Address::new(0, 0),
    data_type: DataType::Unsigned8,
    access: Access::Ro,
    mappable: false,
    group: Group::None,
    name: Range::new(0, 0),
    default: Literal::None,
    low: Literal::None,
    high: Literal::None,
    slot: Slot::NONE,
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest numbers, so that no byte of a row is lost.
    #[test]
    fn a_row_is_its_entry() {
        let range = Range::new(u32::MAX - 1, u32::MAX);
        let literals = [
            Literal::None,
            Literal::Unsigned(u64::MAX),
            Literal::Signed(i64::MIN),
            Literal::Real(-1.5e300),
            Literal::NodeId(u32::MAX),
            Literal::Text(range),
            Literal::Bytes(range),
        ];
        let groups = [
            Group::None,
            Group::Communication,
            Group::Application,
            Group::Manufacturer,
        ];
        for (i, data_type) in DataType::ALL.into_iter().enumerate() {
            let of = |shift: usize| literals[(i + shift) % literals.len()];
            let entry = Entry {
                address: Address::new(0xFEDC, 0xBA),
                data_type,
                access: Access::ALL[i % Access::ALL.len()],
                mappable: i % 2 == 0,
                group: groups[i % groups.len()],
                name: range,
                default: of(0),
                low: of(1),
                high: of(2),
                slot: Slot {
                    offset: u32::MAX - 2,
                    len: u16::MAX - 1,
                },
            };
            assert_eq!(entries(&entry_row(&entry)), [entry]);
        }
    }

    #[test]
    fn a_row_is_its_object() {
        for code in (0..=u8::MAX).filter_map(ObjectCode::from_code) {
            let object = Object {
                index: 0xFEDC,
                code,
                name: Range::new(u32::MAX - 1, u32::MAX),
                first: u32::MAX - 2,
                count: u16::MAX - 1,
            };
            assert_eq!(objects(&object_row(&object)), [object]);
        }
    }
}
