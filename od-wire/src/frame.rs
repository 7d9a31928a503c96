//! The CAN frame, and its identifier.

use core::fmt;
use embedded_can::{ExtendedId, Id, StandardId};

/// A CAN identifier, 11 or 29 bits long.
///
/// The largest standard one is 7FFh, the largest extended one 1FFF_FFFFh; a value
/// of this type cannot hold more.
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

    /// The identifier without the length mark: 0–1FFF_FFFFh.
    pub const fn raw(self) -> u32 {
        self.0 & !EXTENDED
    }

    /// Is it 29 bits long?
    pub const fn is_extended(self) -> bool {
        self.0 & EXTENDED != 0
    }

    /// The 11 bits, if it is that short.
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
        if self.is_extended() {
            write!(f, "{:08X}", self.raw())
        } else {
            write!(f, "{:03X}", self.raw())
        }
    }
}

impl fmt::Debug for CanId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A classical CAN frame: a data frame of 0–8 bytes, or a remote frame with a DLC of 0–8.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Frame {
    id: CanId,
    dlc: u8,
    remote: bool,
    data: [u8; 8],
}

impl Frame {
    /// A data frame; bytes past the eighth are left out.
    #[inline]
    pub fn new(id: CanId, bytes: &[u8]) -> Self {
        let dlc = bytes.len().min(8);
        let mut data = [0; 8];
        data[..dlc].copy_from_slice(&bytes[..dlc]);
        Self {
            id,
            dlc: dlc as u8,
            remote: false,
            data,
        }
    }

    /// A data frame with an 11-bit identifier.
    pub fn standard(id: u16, bytes: &[u8]) -> Self {
        Self::new(CanId::standard(id), bytes)
    }

    /// A data frame of eight bytes, which is what every SDO answer is.
    #[inline]
    pub const fn full(id: CanId, data: [u8; 8]) -> Self {
        Self {
            id,
            dlc: 8,
            remote: false,
            data,
        }
    }

    /// A data frame of the first `dlc` bytes of `data`, 8 at most; the rest have to be 0.
    #[inline]
    pub const fn with_dlc(id: CanId, data: [u8; 8], dlc: u8) -> Self {
        Self {
            id,
            dlc: if dlc > 8 { 8 } else { dlc },
            remote: false,
            data,
        }
    }

    /// A remote frame that asks for `dlc` bytes, 8 at most.
    pub const fn remote(id: CanId, dlc: u8) -> Self {
        Self {
            id,
            dlc: if dlc > 8 { 8 } else { dlc },
            remote: true,
            data: [0; 8],
        }
    }

    /// Any frame of the `embedded-can` ecosystem.
    pub fn from_can(frame: &impl embedded_can::Frame) -> Self {
        if frame.is_remote_frame() {
            Self::remote(frame.id().into(), frame.dlc().min(8) as u8)
        } else {
            Self::new(frame.id().into(), frame.data())
        }
    }

    /// The identifier.
    #[inline]
    pub const fn id(&self) -> CanId {
        self.id
    }

    /// The data length code, 0–8.
    #[inline]
    pub const fn dlc(&self) -> u8 {
        self.dlc
    }

    /// Is it a remote frame?
    #[inline]
    pub const fn is_remote(&self) -> bool {
        self.remote
    }

    /// The data; empty for a remote frame.
    #[inline]
    pub fn data(&self) -> &[u8] {
        let len = if self.remote {
            0
        } else {
            usize::from(self.dlc).min(8)
        };
        &self.data[..len]
    }

    /// All eight bytes; those past the DLC are 0.
    #[inline]
    pub const fn bytes(&self) -> &[u8; 8] {
        &self.data
    }
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        (data.len() <= 8).then(|| Self::new(id.into().into(), data))
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        (dlc <= 8).then(|| Self::remote(id.into().into(), dlc as u8))
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
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn prints_like_candump() {
        assert_eq!(
            Frame::standard(0x181, &[0x92, 0x95]).to_string(),
            "181#9295"
        );
        assert_eq!(
            Frame::remote(CanId::standard(0x701), 0).to_string(),
            "701#R"
        );
        assert_eq!(
            Frame::remote(CanId::extended(0x18F), 4).to_string(),
            "0000018F#R4"
        );
    }

    #[test]
    fn survives_the_embedded_can_traits() {
        for frame in [
            Frame::standard(0x7FF, &[1, 2, 3]),
            Frame::new(CanId::extended(0x1FFF_FFFF), &[9; 8]),
            Frame::remote(CanId::standard(5), 8),
        ] {
            assert_eq!(Frame::from_can(&frame), frame);
        }
    }
}
