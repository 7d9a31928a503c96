//! Values of variable length. A dictionary without them gets no code for them.

use crate::entry::Slot;
use crate::row::Row;
use crate::types::Kind;

/// Limits, texts and bytes of a dictionary that its rows refer to.
#[derive(Clone, Copy, Debug)]
pub struct Arenas<'a> {
    /// Parts of rows that do not fit into them.
    pub pool: &'a [u32],
    /// Defaults of VISIBLE_STRINGs.
    pub text: &'a str,
    /// Defaults of OCTET_STRINGs, UNICODE_STRINGs and DOMAINs.
    pub blob: &'a [u8],
}

type Value = for<'b> fn(&Arenas<'b>, &'b [u8], &Row) -> &'b [u8];
type Room = for<'b> fn(&Arenas<'_>, &'b mut [u8], &Row, usize) -> Option<&'b mut [u8]>;

/// Functions for a dictionary with strings or DOMAINs. They are pointers in data, so a firmware
/// whose dictionary has none does not contain them.
#[derive(Debug)]
pub struct Varying {
    /// Bytes of such a value among those of the store; its default if the store does not have it.
    pub value: Value,
    /// Place in the store of a value of this length, which it has from now on; `None`: it is too
    /// long.
    pub room: Room,
}

impl Varying {
    /// Functions for a dictionary that may have such values.
    pub const SOME: Option<&Self> = Some(&Self { value, room });

    /// Functions for a dictionary with these rows; `None` if they have no such values.
    pub const fn of(rows: &[Row]) -> Option<&'static Self> {
        let mut rest = rows;
        while let [row, others @ ..] = rest {
            if row.is_variable() {
                return Self::SOME;
            }
            rest = others;
        }
        None
    }
}

/// The value is two bytes of length, then its bytes.
fn value<'b>(arenas: &Arenas<'b>, values: &'b [u8], row: &Row) -> &'b [u8] {
    let Slot { offset, len } = row.slot(arenas.pool);
    let rest = values.get(offset as usize..);
    match rest.and_then(|rest| rest.get(..len.into())) {
        Some([low, high, rest @ ..]) => {
            let len = usize::from(u16::from_le_bytes([*low, *high]));
            rest.get(..len).unwrap_or(rest)
        }
        _ => default(arenas, row),
    }
}

/// Works on bytes, since code that checks the boundaries of characters is not small.
fn default<'b>(arenas: &Arenas<'b>, row: &Row) -> &'b [u8] {
    let range = row.range(arenas.pool);
    match row.kind() {
        Kind::Text => range.of(arenas.text.as_bytes()),
        _ => range.of(arenas.blob),
    }
}

fn room<'b>(
    arenas: &Arenas<'_>,
    values: &'b mut [u8],
    row: &Row,
    len: usize,
) -> Option<&'b mut [u8]> {
    let slot = row.slot(arenas.pool);
    let rest = values.get_mut(slot.offset as usize..)?;
    let [low, high, room @ ..] = rest.get_mut(..slot.len.into())? else {
        return None;
    };
    let room = room.get_mut(..len)?;
    // The room is shorter than 64 KiB, so the length fits.
    [*low, *high] = (len as u16).to_le_bytes();
    Some(room)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Access, Address, DataType, Entry, Group, Literal, ObjectCode, Range};

    /// A row whose default, if it is a string, is at the start of the pool.
    fn row(data_type: DataType, default: Literal, len: u16) -> Row {
        let entry = Entry {
            address: Address::new(0x2000, 0),
            data_type,
            access: Access::Rw,
            mappable: false,
            group: Group::None,
            name: Range::new(0, 0),
            default,
            low: Literal::None,
            high: Literal::None,
            slot: Slot { offset: 1, len },
        };
        Row::new(&entry, ObjectCode::Var, 0, 0)
    }

    #[test]
    fn only_strings_and_domains_vary() {
        let number = row(DataType::Unsigned32, Literal::None, 4);
        for varying in [DataType::VisibleString, DataType::Domain] {
            let varying = row(varying, Literal::None, 6);
            assert!(Varying::of(&[number, varying]).is_some());
        }
        assert!(Varying::of(&[number]).is_none());
        assert!(Varying::of(&[]).is_none());
    }

    #[test]
    fn a_string_is_its_length_and_its_bytes() {
        let text = Literal::Text(Range::new(1, 3));
        let rows = [row(DataType::VisibleString, text, 6)];
        let arenas = Arenas {
            pool: &[1, 3, 6],
            text: "a text",
            blob: &[],
        };
        let mut values = [9, 0, 0, 0, 0, 0, 0, 9];
        assert_eq!(value(&arenas, &[], &rows[0]), b" te");
        assert_eq!(value(&arenas, &values, &rows[0]), b"");
        assert!(room(&arenas, &mut values, &rows[0], 5).is_none());
        assert!(room(&arenas, &mut values[..6], &rows[0], 1).is_none());
        assert_eq!(values, [9, 0, 0, 0, 0, 0, 0, 9]);
        let four = room(&arenas, &mut values, &rows[0], 4).unwrap();
        four.copy_from_slice(b"abcd");
        assert_eq!(values, *b"\x09\x04\x00abcd\x09");
        assert_eq!(value(&arenas, &values, &rows[0]), b"abcd");
        // A length that the place does not have.
        values[1] = 200;
        assert_eq!(value(&arenas, &values, &rows[0]), b"abcd");
    }
}
