//! The bits of a frame on the wire (ISO 11898-1, classical frame format): fields, CRC and stuff
//! bits.

use std::prelude::v1::*;

use od_runtime::Frame;

/// Field of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// Start of frame.
    Start,
    /// Identifier; of an extended frame its first 11 bits.
    Identifier,
    /// SRR of an extended frame.
    Substitute,
    /// IDE: the identifier has 29 bits.
    Extension,
    /// The last 18 bits of the identifier of an extended frame.
    IdentifierExtension,
    /// RTR: remote frame.
    Remote,
    /// Reserved bits.
    Reserved,
    /// DLC.
    Length,
    /// Data byte with this number, counted from 0.
    Data(u8),
    /// CRC sequence.
    Crc,
    /// CRC delimiter.
    CrcDelimiter,
    /// Acknowledge slot.
    Acknowledge,
    /// Acknowledge delimiter.
    AcknowledgeDelimiter,
    /// End of frame.
    End,
}

/// One bit on the wire.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Bit {
    /// Recessive (1) or dominant (0).
    pub recessive: bool,
    /// Field. A stuff bit belongs to the field of the bit before it.
    pub part: Part,
    /// Inserted after five equal bits.
    pub stuffed: bool,
}

/// Bits between two frames (intermission).
pub(super) const INTERMISSION: u64 = 3;
/// Bits after the acknowledge slot.
pub(super) const BEHIND_ACKNOWLEDGE: u64 = 8;
/// Polynomial of the CRC sequence without its highest bit.
const POLYNOMIAL: u16 = 0x4599;

/// Returns the bits of an acknowledged frame, from the start of frame to the last bit of
/// its end.
pub fn bits(frame: &Frame) -> Vec<Bit> {
    let mut plain = Plain::default();
    let (raw, remote) = (frame.id().raw(), frame.is_remote());
    plain.put(Part::Start, 0, 1);
    if frame.id().is_extended() {
        plain.put(Part::Identifier, raw >> 18, 11);
        plain.put(Part::Substitute, 1, 1);
        plain.put(Part::Extension, 1, 1);
        plain.put(Part::IdentifierExtension, raw, 18);
        plain.put(Part::Remote, remote.into(), 1);
        plain.put(Part::Reserved, 0, 2);
    } else {
        plain.put(Part::Identifier, raw, 11);
        plain.put(Part::Remote, remote.into(), 1);
        plain.put(Part::Extension, 0, 1);
        plain.put(Part::Reserved, 0, 1);
    }
    plain.put(Part::Length, frame.dlc().into(), 4);
    if !remote {
        for (number, byte) in (0..).zip(frame.data()) {
            plain.put(Part::Data(number), u32::from(*byte), 8);
        }
    }
    let crc = crc(&plain.0);
    plain.put(Part::Crc, crc.into(), 15);
    let mut bits = stuff(&plain.0);
    let mut end = Plain::default();
    end.put(Part::CrcDelimiter, 1, 1);
    end.put(Part::Acknowledge, 0, 1);
    end.put(Part::AcknowledgeDelimiter, 1, 1);
    end.put(Part::End, 0x7F, 7);
    bits.append(&mut end.0);
    bits
}

/// Returns the number of bits for which a frame keeps the line busy: an acknowledged frame with its stuff bits, and the
/// intermission after it.
///
/// ```
/// use od_sim::line::bits::occupied;
/// use od_wire::Frame;
///
/// // A SYNC message: 44 bits of a frame without data, 4 stuff bits, 3 bits of intermission.
/// assert_eq!(occupied(&Frame::standard(0x080, &[])), 51);
/// ```
pub fn occupied(frame: &Frame) -> u64 {
    count(frame) + INTERMISSION
}

/// Returns the number of bits of an acknowledged frame without a list; [`bits`] has the same number.
pub(super) fn count(frame: &Frame) -> u64 {
    let mut plain = Word::default();
    let (raw, remote) = (frame.id().raw(), u32::from(frame.is_remote()));
    if frame.id().is_extended() {
        // Start, first part of the identifier, SRR, IDE, second part, RTR, reserved bits.
        plain.put((raw >> 18) << 2 | 0b11, 14);
        plain.put((raw & 0x3_FFFF) << 3 | remote << 2, 21);
    } else {
        // Start, identifier, RTR, IDE, reserved bit.
        plain.put(raw << 3 | remote << 2, 15);
    }
    plain.put(frame.dlc().into(), 4);
    for byte in frame.data() {
        plain.put((*byte).into(), 8);
    }
    // Dominant bits before the first one do not change the CRC, so it can be computed from whole bytes.
    let crc = plain.bits.to_be_bytes().iter().fold(0u16, |crc, byte| {
        let at = (crc >> 7) as u8 ^ byte;
        (crc << 8 & 0x7FFF) ^ REMAINDERS[usize::from(at)]
    });
    plain.put(crc.into(), 15);
    let Word { bits: word, len } = plain;
    let mut rest = word << (u128::BITS - len);
    let (mut last, mut run, mut stuffed) = (2, 0, 0);
    for _ in 0..len {
        let bit = (rest >> 127) as u8;
        rest <<= 1;
        run = if bit == last { run + 1 } else { 1 };
        last = bit;
        if run == 5 {
            (last, run) = (1 - bit, 1);
            stuffed += 1;
        }
    }
    u64::from(len) + stuffed + END
}

/// Bits; the last one is the lowest.
#[derive(Default)]
struct Word {
    bits: u128,
    len: u32,
}

impl Word {
    fn put(&mut self, value: u32, count: u32) {
        self.bits = self.bits << count | u128::from(value);
        self.len += count;
    }
}

/// Bits after the CRC sequence: delimiter, acknowledge slot, delimiter, end of frame.
const END: u64 = 3 + 7;

/// Remainder of the CRC for each byte.
static REMAINDERS: [u16; 256] = {
    let mut all = [0; 256];
    let mut byte = 0;
    while byte < all.len() {
        let (mut crc, mut bit) = ((byte as u16) << 7, 0);
        while bit < 8 {
            let next = crc & 0x4000 != 0;
            crc = crc << 1 & 0x7FFF;
            if next {
                crc ^= POLYNOMIAL;
            }
            bit += 1;
        }
        all[byte] = crc;
        byte += 1;
    }
    all
};

/// The order of arbitration: of two frames that start together, the one with the lower number is
/// sent first. It has the bits that decide, the most significant first.
pub fn arbitration(frame: &Frame) -> u32 {
    let (raw, remote) = (frame.id().raw(), u32::from(frame.is_remote()));
    if frame.id().is_extended() {
        (raw >> 18) << 21 | 0b11 << 19 | (raw & 0x3_FFFF) << 1 | remote
    } else {
        raw << 21 | remote << 20
    }
}

#[derive(Default)]
struct Plain(Vec<Bit>);

impl Plain {
    /// The lowest `count` bits of a value, highest first.
    fn put(&mut self, part: Part, value: u32, count: u8) {
        self.0.extend((0..count).rev().map(|place| Bit {
            recessive: value >> place & 1 == 1,
            part,
            stuffed: false,
        }));
    }
}

fn crc(bits: &[Bit]) -> u16 {
    bits.iter().fold(0, |crc, bit| {
        let next = bit.recessive != (crc & 0x4000 != 0);
        let shifted = crc << 1 & 0x7FFF;
        if next { shifted ^ POLYNOMIAL } else { shifted }
    })
}

/// Inserts a bit of the other level after five equal bits; it counts for the next five.
fn stuff(plain: &[Bit]) -> Vec<Bit> {
    let mut all: Vec<Bit> = Vec::with_capacity(plain.len() * 6 / 5);
    let mut run = 0;
    for bit in plain {
        let same = all
            .last()
            .is_some_and(|last| last.recessive == bit.recessive);
        run = if same { run + 1 } else { 1 };
        all.push(*bit);
        if run == 5 {
            all.push(Bit {
                recessive: !bit.recessive,
                stuffed: true,
                ..*bit
            });
            run = 1;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use od_runtime::CanId;

    use super::*;

    /// Start of frame, identifier, RTR, IDE, r0, DLC, data; the CRC was divided by hand; the end.
    #[test]
    fn a_frame_bit_by_bit() {
        let all = bits(&Frame::standard(0x14, &[1]));
        let plain = all.iter().filter(|bit| !bit.stuffed);
        let plain: String = plain
            .map(|bit| if bit.recessive { '1' } else { '0' })
            .collect();
        assert_eq!(
            plain,
            "0 00000010100 0 0 0 0001 00000001 111011101010011 1 0 1 1111111"
                .replace(' ', "")
                .as_str()
        );
    }

    #[test]
    fn length_without_stuff_bits_is_44_or_64_plus_8_per_byte() {
        let plain = |frame: &Frame| bits(frame).iter().filter(|bit| !bit.stuffed).count();
        for len in 0..=8 {
            let data = &[0xA5; 8][..len];
            let standard = Frame::new(CanId::standard(0x2AA), data).expect("a frame");
            assert_eq!(plain(&standard), 44 + 8 * len);
            let extended = Frame::new(CanId::extended(0x0AAA_AAAA), data).expect("a frame");
            assert_eq!(plain(&extended), 64 + 8 * len);
            let remote = Frame::remote(CanId::standard(0x2AA), len as u8).expect("a frame");
            assert_eq!(plain(&remote), 44, "a remote frame has no data");
        }
    }

    #[test]
    fn the_number_of_bits_is_that_of_the_list() {
        let mut seed = 1u64;
        for round in 0..5_000u32 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let raw = (seed >> 32) as u32;
            let id = match round % 2 {
                0 => CanId::standard(raw as u16),
                _ => CanId::extended(raw),
            };
            // Include long sequences of one level.
            let data = match round % 3 {
                0 => [0; 8],
                1 => (seed & 0x00FF_FF00_F0F0_0000).to_be_bytes(),
                _ => seed.to_le_bytes(),
            };
            let len = (round % 9) as u8;
            let frames = [Frame::new(id, &data[..len.into()]), Frame::remote(id, len)];
            for frame in frames.into_iter().flatten() {
                assert_eq!(count(&frame), bits(&frame).len() as u64, "{frame}");
            }
        }
    }

    #[test]
    fn five_equal_bits_are_followed_by_another_one() {
        for frame in [
            Frame::standard(0, &[0; 8]),
            Frame::standard(0x7FF, &[0xFF; 8]),
            Frame::standard(0x181, &[0, 0, 0xF8, 0x7F]),
        ] {
            let all = bits(&frame);
            let stuffed = &all[..all.len() - 10];
            let run = stuffed
                .windows(6)
                .any(|six| six.iter().all(|bit| bit.recessive == six[0].recessive));
            assert!(!run, "{frame}");
            for pair in stuffed.windows(2).filter(|pair| pair[1].stuffed) {
                assert_ne!(pair[0].recessive, pair[1].recessive, "{frame}");
            }
        }
    }

    /// A receiver divides the received bits with the CRC, and gets 0.
    #[test]
    fn the_crc_leaves_no_remainder() {
        for frame in [
            Frame::standard(0x601, &[0x40, 4, 0x60, 0]),
            Frame::standard(0x80, &[]),
        ] {
            let read: Vec<_> = bits(&frame)
                .into_iter()
                .filter(|bit| !bit.stuffed)
                .collect();
            assert_eq!(crc(&read[..read.len() - 10]), 0);
            let mut wrong = read[..read.len() - 10].to_vec();
            wrong[7].recessive = !wrong[7].recessive;
            assert_ne!(crc(&wrong), 0);
        }
    }

    #[test]
    fn the_lower_identifier_wins_then_data_before_remote_then_11_bits_before_29() {
        let order = [
            Frame::standard(0x080, &[]),
            Frame::remote(CanId::standard(0x080), 0).expect("a frame"),
            Frame::new(CanId::extended(0x080 << 18), &[]).expect("a frame"),
            Frame::new(CanId::extended(0x080 << 18 | 1), &[]).expect("a frame"),
            Frame::standard(0x081, &[]),
            Frame::standard(0x701, &[]),
        ];
        assert!(
            order
                .windows(2)
                .all(|two| arbitration(&two[0]) < arbitration(&two[1]))
        );
    }
}
