//! The CAN frame, and its CAN-ID.

use core::fmt;
use embedded_can::{ExtendedId, Id, StandardId};

/// A CAN-ID: the identifier of a frame, 11 or 29 bits long.
///
/// At most 7FFh if standard, 1FFF_FFFFh if extended.
///
/// ```
/// use od_wire::CanId;
///
/// assert_eq!(CanId::standard(0x185).to_string(), "185");
/// assert_eq!(CanId::extended(0x185).as_standard(), None);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CanId(u32);

const EXTENDED: u32 = 1 << 31;

impl CanId {
    /// An 11-bit identifier from the low 11 bits of `raw`.
    pub const fn standard(raw: u16) -> Self {
        Self((raw & 0x7FF) as u32)
    }

    /// A 29-bit identifier from the low 29 bits of `raw`.
    pub const fn extended(raw: u32) -> Self {
        Self(raw & 0x1FFF_FFFF | EXTENDED)
    }

    /// Returns the number, 0 to 1FFF_FFFFh.
    pub const fn raw(self) -> u32 {
        self.0 & !EXTENDED
    }

    /// Returns whether it has 29 bits.
    pub const fn is_extended(self) -> bool {
        self.0 & EXTENDED != 0
    }

    /// Returns the 11 bits; `None` if it has 29.
    pub const fn as_standard(self) -> Option<u16> {
        if self.is_extended() {
            None
        } else {
            Some(self.0 as u16)
        }
    }
}

impl From<Id> for CanId {
    fn from(id: Id) -> Self {
        match id {
            Id::Standard(id) => Self::standard(id.as_raw()),
            Id::Extended(id) => Self::extended(id.as_raw()),
        }
    }
}

impl From<CanId> for Id {
    fn from(id: CanId) -> Self {
        match (id.as_standard(), ExtendedId::new(id.raw())) {
            (Some(raw), _) => Id::Standard(StandardId::new(raw).unwrap_or(StandardId::ZERO)),
            (None, extended) => Id::Extended(extended.unwrap_or(ExtendedId::ZERO)),
        }
    }
}

impl fmt::Display for CanId {
    /// As candump prints it: three digits, or eight for an extended one.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = if self.is_extended() { 8 } else { 3 };
        write!(f, "{:0width$X}", self.raw())
    }
}

impl fmt::Debug for CanId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A classical CAN frame: a data frame of 0–8 bytes, or a remote frame with a DLC of 0–8.
///
/// The bytes after the data are always 0, so that equal frames are equal field by field.
///
/// ```
/// use od_wire::{CanId, Frame};
///
/// let frame = Frame::standard(0x601, &[0x40, 0x04, 0x60, 0, 0, 0, 0, 0]);
/// assert_eq!(frame.to_string(), "601#4004600000000000");
/// assert!(Frame::new(CanId::standard(0x181), &[0; 9]).is_none());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Frame {
    id: CanId,
    dlc: u8,
    remote: bool,
    data: [u8; 8],
}

impl Frame {
    /// A data frame; `None` for more than eight bytes.
    #[inline]
    pub fn new(id: CanId, data: &[u8]) -> Option<Self> {
        let mut bytes = [0; 8];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        // `get_mut` has checked that the length is at most 8.
        Some(Self::data_frame(id, bytes, data.len() as u8))
    }

    /// A data frame whose length the compiler knows: an array of more than eight bytes does
    /// not compile.
    ///
    /// ```compile_fail
    /// use od_wire::{CanId, Frame};
    /// let frame = Frame::of(CanId::standard(0x181), &[0; 9]);
    /// ```
    #[inline]
    pub const fn of<const N: usize>(id: CanId, data: &[u8; N]) -> Self {
        const { assert!(N <= 8, "a CAN frame has at most eight bytes of data") };
        let mut bytes = [0; 8];
        let mut at = 0;
        while at < N {
            bytes[at] = data[at];
            at += 1;
        }
        Self::data_frame(id, bytes, N as u8)
    }

    /// [`Frame::of`] with the low 11 bits of `id` as its identifier.
    #[inline]
    pub const fn standard<const N: usize>(id: u16, data: &[u8; N]) -> Self {
        Self::of(CanId::standard(id), data)
    }

    /// A data frame of eight bytes, as every SDO response is.
    #[inline]
    pub const fn full(id: CanId, data: [u8; 8]) -> Self {
        Self::data_frame(id, data, 8)
    }

    /// A data frame of the first `dlc` bytes of `data`. A DLC of 9–15 means eight bytes, as it
    /// does on the bus (ISO 11898-1).
    #[inline]
    pub const fn with_dlc(id: CanId, data: [u8; 8], dlc: u8) -> Self {
        let dlc = if dlc > 8 { 8 } else { dlc };
        let kept = match dlc {
            0 => 0,
            dlc => u64::MAX >> (64 - 8 * dlc as u32),
        };
        let data = (u64::from_le_bytes(data) & kept).to_le_bytes();
        Self::data_frame(id, data, dlc)
    }

    /// As [`with_dlc`](Self::with_dlc), without checks: `dlc` is at most 8, and the bytes of `data`
    /// after it are 0.
    #[doc(hidden)]
    pub const fn padded(id: CanId, data: [u8; 8], dlc: u8) -> Self {
        debug_assert!(dlc == 8 || dlc < 8 && u64::from_le_bytes(data) >> (8 * dlc as u32) == 0);
        Self::data_frame(id, data, dlc)
    }

    /// A remote frame that requests `dlc` bytes; `None` for more than eight.
    pub const fn remote(id: CanId, dlc: u8) -> Option<Self> {
        if dlc > 8 {
            return None;
        }
        let mut frame = Self::data_frame(id, [0; 8], dlc);
        frame.remote = true;
        Some(frame)
    }

    /// `dlc` is at most 8, and the bytes of `data` after it are 0.
    #[inline]
    const fn data_frame(id: CanId, data: [u8; 8], dlc: u8) -> Self {
        Self {
            id,
            dlc,
            remote: false,
            data,
        }
    }

    /// Converts a frame of any type of the `embedded-can` ecosystem; `None` if it has more than
    /// eight bytes, so it is not a classical CAN frame.
    pub fn from_can(frame: &impl embedded_can::Frame) -> Option<Self> {
        if frame.is_remote_frame() {
            Self::remote(frame.id().into(), u8::try_from(frame.dlc()).ok()?)
        } else {
            Self::new(frame.id().into(), frame.data())
        }
    }

    /// Converts the frame to any type of the `embedded-can` ecosystem; `None` if that type refuses
    /// it.
    pub fn to_can<F: embedded_can::Frame>(&self) -> Option<F> {
        if self.remote {
            F::new_remote(Id::from(self.id), self.dlc.into())
        } else {
            F::new(Id::from(self.id), self.data())
        }
    }

    /// Returns the CAN-ID.
    #[inline]
    pub const fn id(&self) -> CanId {
        self.id
    }

    /// Returns the data length code, 0 to 8.
    #[inline]
    pub const fn dlc(&self) -> u8 {
        self.dlc
    }

    /// Returns whether it is a remote frame.
    #[inline]
    pub const fn is_remote(&self) -> bool {
        self.remote
    }

    /// Returns the data; empty for a remote frame.
    #[inline]
    pub fn data(&self) -> &[u8] {
        let len = if self.remote { 0 } else { self.dlc.min(8) };
        &self.data[..usize::from(len)]
    }

    /// Returns all eight bytes; those after the DLC are 0.
    #[inline]
    pub const fn bytes(&self) -> &[u8; 8] {
        &self.data
    }
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Self::new(id.into().into(), data)
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        Self::remote(id.into().into(), u8::try_from(dlc).ok()?)
    }

    fn is_extended(&self) -> bool {
        self.id.is_extended()
    }

    fn is_remote_frame(&self) -> bool {
        self.remote
    }

    fn id(&self) -> Id {
        self.id.into()
    }

    fn dlc(&self) -> usize {
        self.dlc.into()
    }

    fn data(&self) -> &[u8] {
        Frame::data(self)
    }
}

impl fmt::Display for Frame {
    /// As candump writes it into a log: `181#92950700`, `701#R`, `181#R4`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}#", self.id)?;
        if self.remote {
            return match self.dlc {
                0 => f.write_str("R"),
                dlc => write!(f, "R{dlc}"),
            };
        }
        self.data()
            .iter()
            .try_for_each(|byte| write!(f, "{byte:02X}"))
    }
}

impl fmt::Debug for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    #[test]
    fn frames_are_shown_as_candump_prints_them() {
        let remote = |id, dlc| Frame::remote(id, dlc).unwrap().to_string();
        assert_eq!(
            Frame::standard(0x181, &[0x92, 0x95]).to_string(),
            "181#9295"
        );
        assert_eq!(remote(CanId::standard(0x701), 0), "701#R");
        assert_eq!(remote(CanId::extended(0x18F), 4), "0000018F#R4");
    }

    #[test]
    fn frames_survive_the_embedded_can_traits() {
        for frame in [
            Frame::standard(0x7FF, &[1, 2, 3]),
            Frame::of(CanId::extended(0x1FFF_FFFF), &[9; 8]),
            Frame::remote(CanId::standard(5), 8).unwrap(),
        ] {
            assert_eq!(Frame::from_can(&frame), Some(frame));
            assert_eq!(frame.to_can(), Some(frame));
        }
    }

    #[test]
    fn frames_that_embedded_can_refuses_give_none() {
        let id = CanId::standard(1);
        assert_eq!(Frame::new(id, &[7; 8]), Some(Frame::full(id, [7; 8])));
        assert_eq!(Frame::new(id, &[7; 9]), None);
        assert_eq!(Frame::remote(id, 9), None);
        type Can = Frame;
        assert_eq!(<Can as embedded_can::Frame>::new(id, &[0; 9]), None);
        assert_eq!(<Can as embedded_can::Frame>::new_remote(id, 9), None);
        assert_eq!(<Can as embedded_can::Frame>::new_remote(id, 256), None);
        let longest = <Can as embedded_can::Frame>::new_remote(id, 8).unwrap();
        assert_eq!((longest.dlc(), longest.data()), (8, &[][..]));
    }

    #[test]
    fn the_bytes_after_the_data_are_0() {
        let id = CanId::standard(1);
        for dlc in 0..=15u8 {
            let len = usize::from(dlc.min(8));
            let frame = Frame::with_dlc(id, [0xFF; 8], dlc);
            assert_eq!(Some(frame), Frame::new(id, &[0xFF; 8][..len]));
            assert_eq!(frame.bytes()[len..], [0; 8][len..]);
        }
    }
}
