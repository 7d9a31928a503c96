//! Numbers as the bus and the store have them: little-endian, in as many bytes as their type.

use od_model::Slot;
use od_model::row::Row;

/// The number that up to eight bytes are. The usual lengths are one load each. On a microcontroller it is a
/// call.
#[cfg_attr(target_os = "none", inline(never))]
#[cfg_attr(not(target_os = "none"), inline(always))]
pub(crate) fn little_endian(bytes: &[u8]) -> u64 {
    match *bytes {
        [a] => a.into(),
        [a, b] => u16::from_le_bytes([a, b]).into(),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]).into(),
        [a, b, c, d, e, f, g, h] => u64::from_le_bytes([a, b, c, d, e, f, g, h]),
        _ => odd(bytes),
    }
}

/// The value of a [plain](Row::plain) row that one frame carries, and how many bytes it is shorter than
/// four. Without bytes enough behind it for one load it has to be read byte by byte: `None`.
#[inline(always)]
pub(crate) fn word(values: &[u8], row: &Row) -> Option<(u32, u32)> {
    let Slot { offset, len } = row.plain();
    let at = offset as usize;
    let bytes = *values.get(at..at + 4)?.first_chunk()?;
    let unused = u32::from(len).wrapping_neg() & 3;
    let word = u32::from_le_bytes(bytes);
    Some((word << (8 * unused) >> (8 * unused), unused))
}

/// Puts the low bytes of a number in the place of a value that has so many bits less than four bytes.
/// Returns these bytes. As for [`word`], there have to be bytes enough behind it.
#[inline(always)]
pub(crate) fn put_word(values: &mut [u8], at: usize, unused: u32, number: u32) -> Option<u32> {
    let bytes = values.get_mut(at..at + 4)?.first_chunk_mut()?;
    if unused == 0 {
        *bytes = number.to_le_bytes();
        return Some(number);
    }
    let mask = u32::MAX >> (unused & 31);
    let value = number & mask;
    *bytes = (u32::from_le_bytes(*bytes) & !mask | value).to_le_bytes();
    Some(value)
}

/// As [`little_endian`], where a call is better than its code.
#[cfg_attr(target_os = "none", inline(always))]
#[cfg_attr(not(target_os = "none"), inline(never))]
pub(crate) fn number_in(bytes: &[u8]) -> u64 {
    little_endian(bytes)
}

/// The number of a length that few have.
#[cold]
#[inline(never)]
fn odd(bytes: &[u8]) -> u64 {
    let bytes = bytes.iter().take(8).rev();
    bytes.fold(0, |number, byte| number << 8 | u64::from(*byte))
}

/// Puts the low bytes of a number in their place. The usual lengths are one store each.
#[inline(always)]
pub(crate) fn fill(room: &mut [u8], number: [u8; 8]) {
    let [a, b, c, d, ..] = number;
    if let Ok(room) = <&mut [u8; 4]>::try_from(&mut *room) {
        *room = [a, b, c, d];
    } else {
        let mut rest = u64::from_le_bytes(number);
        for to in room.iter_mut().take(8) {
            *to = rest as u8;
            rest >>= 8;
        }
    }
}

/// Copies as many bytes as both have, in code that cannot fail.
#[inline(never)]
pub(crate) fn copy(to: &mut [u8], from: &[u8]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
}
