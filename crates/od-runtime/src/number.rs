//! Numbers as the bus and the store have them: little-endian, in as many bytes as their type.

/// The number that up to eight bytes are. The usual lengths are one load each.
pub(crate) fn number_in(bytes: &[u8]) -> u64 {
    match *bytes {
        [a] => a.into(),
        [a, b] => u16::from_le_bytes([a, b]).into(),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]).into(),
        [a, b, c, d, e, f, g, h] => u64::from_le_bytes([a, b, c, d, e, f, g, h]),
        _ => odd(bytes),
    }
}

/// The number of a length that few have.
fn odd(bytes: &[u8]) -> u64 {
    let bytes = bytes.iter().take(8).rev();
    bytes.fold(0, |number, byte| number << 8 | u64::from(*byte))
}

/// Puts the low bytes of a number in their place. The usual lengths are one store each.
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
pub(crate) fn copy(to: &mut [u8], from: &[u8]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
}
