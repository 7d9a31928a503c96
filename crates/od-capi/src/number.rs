//! Converts numbers of C with 32 and 64 bits to values of objects and back.

use odkit::{DataType, Entry, Kind, Store};

use crate::answer::{ODKIT_ARGUMENT, ODKIT_TYPE};

/// Bytes of a value, and how many of them are valid.
pub(crate) type ValueBytes = ([u8; 8], usize);

/// Number of bits of an integer type, if it has at most `most`.
fn bits(data_type: DataType, is_signed: bool, most: u8) -> Result<u32, u32> {
    let fits = match data_type.kind() {
        Kind::Signed => is_signed,
        Kind::Unsigned | Kind::Boolean => !is_signed,
        _ => false,
    };
    let bits = data_type.bits().filter(|bits| fits && *bits <= most);
    bits.map(u32::from).ok_or(ODKIT_TYPE)
}

/// The value of an unsigned object of up to `most` bits, or of a BOOLEAN.
pub(crate) fn unsigned(store: &Store<'_>, entry: &Entry, most: u8) -> Result<u64, u32> {
    bits(entry.data_type, false, most)?;
    Ok(store.number(entry))
}

/// The value of a signed object of up to `most` bits.
pub(crate) fn signed(store: &Store<'_>, entry: &Entry, most: u8) -> Result<i64, u32> {
    let unused = 64 - bits(entry.data_type, true, most)?;
    Ok((store.number(entry) as i64) << unused >> unused)
}

/// The value of a REAL32.
pub(crate) fn single(store: &Store<'_>, entry: &Entry) -> Result<f32, u32> {
    match entry.data_type {
        DataType::Real32 => Ok(f32::from_bits(store.number(entry) as u32)),
        _ => Err(ODKIT_TYPE),
    }
}

/// The bytes of an unsigned value of up to `most` bits.
pub(crate) fn from_unsigned(data_type: DataType, value: u64, most: u8) -> Result<ValueBytes, u32> {
    let unused = 64 - bits(data_type, false, most)?;
    if value << unused >> unused != value {
        return Err(ODKIT_ARGUMENT);
    }
    Ok((value.to_le_bytes(), data_type.size().unwrap_or(8)))
}

/// The bytes of a signed value of up to `most` bits.
pub(crate) fn from_signed(data_type: DataType, value: i64, most: u8) -> Result<ValueBytes, u32> {
    let unused = 64 - bits(data_type, true, most)?;
    if value << unused >> unused != value {
        return Err(ODKIT_ARGUMENT);
    }
    Ok((value.to_le_bytes(), data_type.size().unwrap_or(8)))
}

/// The bytes of a REAL32.
pub(crate) fn from_single(data_type: DataType, value: f32) -> Result<ValueBytes, u32> {
    match data_type {
        DataType::Real32 => Ok((u64::from(value.to_bits()).to_le_bytes(), 4)),
        _ => Err(ODKIT_TYPE),
    }
}
