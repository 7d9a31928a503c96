//! Numbers in the form of the bus and the store: little-endian, in as many bytes as their type has.

/// Returns the number in up to eight bytes. For the usual lengths this is one load.
pub(crate) fn number_in(bytes: &[u8]) -> u64 {
    match *bytes {
        [a] => a.into(),
        [a, b] => u16::from_le_bytes([a, b]).into(),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]).into(),
        [a, b, c, d, e, f, g, h] => u64::from_le_bytes([a, b, c, d, e, f, g, h]),
        _ => odd(bytes),
    }
}

/// Returns the number of an unusual length.
fn odd(bytes: &[u8]) -> u64 {
    let bytes = bytes.iter().take(8).rev();
    bytes.fold(0, |number, byte| number << 8 | u64::from(*byte))
}

/// Writes the low bytes of a number. For the usual lengths this is one store.
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

/// Copies the number of bytes of the shorter slice, in code that cannot panic.
pub(crate) fn copy(to: &mut [u8], from: &[u8]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
}
