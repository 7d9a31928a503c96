//! The fields that requests and responses share, and their places in the frame.

use od_model::Address;

/// A frame with command, address and number.
#[inline]
pub(super) const fn head(command: u8, address: Address, number: u32) -> [u8; 8] {
    // Not byte by byte: a microcontroller stores two words.
    let head = command as u64 | (address.index as u64) << 8 | (address.sub as u64) << 24;
    (head | (number as u64) << 32).to_le_bytes()
}

/// A frame with a command and two bytes.
pub(super) const fn short(command: u8, [a, b]: [u8; 2]) -> [u8; 8] {
    [command, a, b, 0, 0, 0, 0, 0]
}

/// The address in a frame.
pub const fn address(data: &[u8; 8]) -> Address {
    Address::new(u16::from_le_bytes([data[1], data[2]]), data[3])
}

/// The number after the address.
pub const fn number(data: &[u8; 8]) -> u32 {
    u32::from_le_bytes([data[4], data[5], data[6], data[7]])
}

/// The toggle bit.
pub const fn toggle(data: &[u8; 8]) -> bool {
    data[0] & 0x10 != 0
}

/// The toggle bit, in its place in the command.
pub(super) fn toggled(toggle: bool) -> u8 {
    u8::from(toggle) << 4
}

/// The indicated size, and the data of an expedited transfer.
pub(super) const fn value(data: &[u8; 8]) -> (Option<u32>, Option<[u8; 4]>) {
    let [command, _, _, _, bytes @ ..] = *data;
    let size = match command & 3 {
        3 => Some(4 - (command >> 2 & 3) as u32),
        1 => Some(number(data)),
        _ => None,
    };
    let expedited = if command & 2 != 0 { Some(bytes) } else { None };
    (size, expedited)
}

/// The frame that begins a transfer with a value, or with its size.
pub(super) fn value_frame(
    command: u8,
    address: Address,
    size: Option<u32>,
    expedited: Option<[u8; 4]>,
) -> [u8; 8] {
    let command = command | u8::from(size.is_some());
    let Some(bytes) = expedited else {
        return head(command, address, size.unwrap_or(0));
    };
    let unused = size.map_or(0, |size| 4 - size.min(4) as u8);
    head(
        command | 2 | unused << 2,
        address,
        u32::from_le_bytes(bytes),
    )
}

/// Returns whether the sender supports a CRC, and the size that it indicates, in a frame that
/// begins a block transfer.
pub(super) const fn block(data: &[u8; 8]) -> (bool, Option<u32>) {
    let size = if data[0] & 2 != 0 {
        Some(number(data))
    } else {
        None
    };
    (wants_crc(data), size)
}

/// Returns whether the sender of a frame that begins a block transfer supports a CRC.
pub const fn wants_crc(data: &[u8; 8]) -> bool {
    data[0] & 4 != 0
}

/// The frame that begins a block transfer of a value.
pub(super) fn block_frame(address: Address, crc: bool, size: Option<u32>) -> [u8; 8] {
    let command = 0xC0 | u8::from(crc) << 2 | u8::from(size.is_some()) << 1;
    head(command, address, size.unwrap_or(0))
}

/// Number of unused bytes of the last segment, and the CRC, at the end of a block transfer.
pub const fn end(data: &[u8; 8]) -> (u8, u16) {
    (data[0] >> 2 & 7, u16::from_le_bytes([data[1], data[2]]))
}

/// The frame at the end of a block transfer.
pub(super) fn end_frame(unused: u8, crc: u16) -> [u8; 8] {
    short(0xC1 | (unused & 7) << 2, crc.to_le_bytes())
}
