//! Up to seven bytes of a value, as segments of both directions contain them.

use super::fields::{toggle, toggled};

/// A segment of a segmented transfer.
///
/// ```
/// use od_wire::sdo::{Response, Segment};
///
/// let segment = Segment::first_of(b"GXMM", false);
/// assert!(segment.last && segment.bytes() == b"GXMM");
/// assert_eq!(Response::UploadSegment(segment).emit()[0], 0x07);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Segment {
    /// Toggle bit.
    pub toggle: bool,
    /// The bytes, of which `len` are valid.
    pub data: [u8; 7],
    /// Number of bytes, 0 to 7.
    pub len: u8,
    /// No more segments follow.
    pub last: bool,
}

impl Segment {
    /// The first segment of `rest`, the bytes of the value that are left.
    pub fn first_of(rest: &[u8], toggle: bool) -> Self {
        let len = rest.len().min(7);
        let mut data = [0; 7];
        data[..len].copy_from_slice(&rest[..len]);
        Self {
            toggle,
            data,
            len: len as u8,
            last: len == rest.len(),
        }
    }

    /// Returns the valid bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.data[..usize::from(self.len.min(7))]
    }

    /// Returns the valid bytes of a segment, inside its frame, and whether it is the last one.
    pub fn of_frame([command, data @ ..]: &[u8; 8]) -> (&[u8], bool) {
        let unused = usize::from(command >> 1 & 7);
        (&data[..7 - unused], command & 1 != 0)
    }

    pub(super) const fn parse(frame: &[u8; 8]) -> Self {
        let [command, data @ ..] = *frame;
        Self {
            toggle: toggle(frame),
            data,
            len: 7 - (command >> 1 & 7),
            last: command & 1 != 0,
        }
    }

    pub(super) fn emit(self) -> [u8; 8] {
        let [a, b, c, d, e, f, g] = self.data;
        let command = toggled(self.toggle) | (7 - self.len.min(7)) << 1 | u8::from(self.last);
        [command, a, b, c, d, e, f, g]
    }
}

/// The frame of a segment with the first bytes of `rest`, the bytes of the value that are left.
#[inline]
pub fn segment(toggle: bool, rest: &[u8], last: bool) -> [u8; 8] {
    let unused = 7 - rest.len().min(7) as u8;
    led_by(toggled(toggle) | unused << 1 | u8::from(last), rest).to_le_bytes()
}

/// The frame of segment `sequence` of a block, 1 to 127, with the first bytes of `rest`, the bytes
/// of the value that are left. The last segment of the transfer has bit 7 set.
#[inline]
pub fn block_segment(sequence: u8, rest: &[u8], last: bool) -> [u8; 8] {
    led_by(sequence | u8::from(last) << 7, rest).to_le_bytes()
}

/// A frame with `head` as its first byte and up to seven further bytes, as a number.
fn led_by(head: u8, rest: &[u8]) -> u64 {
    let rest = rest.iter().take(7).rev();
    let number = rest.fold(0, |number, byte| number << 8 | u64::from(*byte));
    number << 8 | u64::from(head)
}

/// Number of segments of a block transfer with `len` bytes; an empty value needs one.
pub const fn block_segments(len: usize) -> usize {
    if len == 0 { 1 } else { len.div_ceil(7) }
}

/// Number of unused bytes in the last segment of a block transfer, 0 to 7, for a value of `len`
/// bytes.
pub const fn unused(len: usize) -> u8 {
    (block_segments(len) * 7 - len) as u8
}

/// CRC-16 with polynomial 1021h and start value 0 (CiA 301, chapter 7.2.4.3.16).
pub fn crc16(data: &[u8]) -> u16 {
    crc16_after(0, data)
}

/// Continues a [`crc16`]: `before` is the checksum of the bytes before `data`.
pub fn crc16_after(before: u16, data: &[u8]) -> u16 {
    data.iter().fold(before, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte) << 8, |crc, _| {
            if crc & 0x8000 != 0 {
                crc << 1 ^ 0x1021
            } else {
                crc << 1
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_segment_has_the_rest_of_the_value() {
        for (len, segments, rest) in [(0, 1, 7), (1, 1, 6), (7, 1, 0), (8, 2, 6), (14, 2, 0)] {
            assert_eq!(
                (block_segments(len), unused(len)),
                (segments, rest),
                "{len}"
            );
        }
        let segment = Segment::first_of(&[1, 2, 3, 4, 5, 6, 7, 8], true);
        assert!(!segment.last && segment.bytes() == [1, 2, 3, 4, 5, 6, 7]);
        assert!(Segment::first_of(&[1], true).last);
        assert_eq!(block_segment(2, &[9, 8], true), [0x82, 9, 8, 0, 0, 0, 0, 0]);
        for len in 0..=8 {
            let rest = &[1, 2, 3, 4, 5, 6, 7, 8][..len];
            for (toggle, last) in [(false, len <= 7), (true, len <= 7)] {
                let made = Segment::first_of(rest, toggle);
                assert_eq!(super::segment(toggle, rest, last), made.emit(), "{len}");
            }
        }
    }

    #[test]
    fn crc_of_the_check_value_is_that_of_the_standard() {
        assert_eq!(crc16(b"123456789"), 0x31C3);
        assert_eq!(crc16(b""), 0);
        assert_eq!(crc16_after(crc16(b"1234"), b"56789"), 0x31C3);
    }
}
