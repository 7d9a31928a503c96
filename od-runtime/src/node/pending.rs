//! Kinds of frames that may wait to be sent, so that most calls for a frame have one test.

/// The response in `answer`.
pub(super) const ANSWER: u8 = 1;
/// A PDO, which the inhibit time may hold back.
pub(super) const PDO: u8 = 2;
/// Anything else: a call had the device. Then the next deadline is not known either.
pub(super) const OTHER: u8 = 4;
/// The first TPDO, by a SYNC that had nothing else to do. The bits above it are those of the others.
pub(super) const FIRST_MARK: u8 = 8;
/// All of them.
pub(super) const MARKS: u8 = 0xF8;

/// Position of the first TPDO that is marked.
#[inline(always)]
pub(super) const fn position(pending: u8) -> usize {
    let bit = (pending as u32).trailing_zeros();
    bit.wrapping_sub(FIRST_MARK.trailing_zeros()) as usize
}
