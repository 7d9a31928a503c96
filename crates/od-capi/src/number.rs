//! Integers of C, which have 32 bits, as values of an object and back.

use odkit::{DataType, Entry, Kind, Store};

use crate::answer::{ODKIT_ARGUMENT, ODKIT_TYPE};

/// Bits of an integer of up to 32 bits.
fn bits(data_type: DataType, is_signed: bool) -> Result<u32, u32> {
    let fits = match data_type.kind() {
        Kind::Signed => is_signed,
        Kind::Unsigned | Kind::Boolean => !is_signed,
        _ => false,
    };
    let bits = data_type.bits().filter(|bits| fits && *bits <= 32);
    bits.map(u32::from).ok_or(ODKIT_TYPE)
}

/// The value of an unsigned object or a BOOLEAN.
pub(crate) fn unsigned(store: &Store<'_>, entry: &Entry) -> Result<u32, u32> {
    bits(entry.data_type, false)?;
    Ok(store.number(entry) as u32)
}

/// The value of a signed object.
pub(crate) fn signed(store: &Store<'_>, entry: &Entry) -> Result<i32, u32> {
    let unused = 32 - bits(entry.data_type, true)?;
    Ok((store.number(entry) as i32) << unused >> unused)
}

/// The bytes of an unsigned value, and how many of them count.
pub(crate) fn from_unsigned(data_type: DataType, value: u32) -> Result<([u8; 4], usize), u32> {
    let bits = bits(data_type, false)?;
    if u64::from(value) >> bits != 0 {
        return Err(ODKIT_ARGUMENT);
    }
    Ok((value.to_le_bytes(), data_type.size().unwrap_or(4)))
}

/// The bytes of a signed value, and how many of them count.
pub(crate) fn from_signed(data_type: DataType, value: i32) -> Result<([u8; 4], usize), u32> {
    let unused = 32 - bits(data_type, true)?;
    if value << unused >> unused != value {
        return Err(ODKIT_ARGUMENT);
    }
    Ok((value.to_le_bytes(), data_type.size().unwrap_or(4)))
}
