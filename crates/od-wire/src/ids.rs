//! Node IDs and COB-IDs, which hold valid values only.

use core::fmt;

use crate::frame::CanId;

/// A node ID, 1–127 (CiA 301). The number minus one is stored, so that node ID 1 is all zeros.
///
/// ```
/// use od_wire::{CanId, NodeId};
///
/// let node = NodeId::new(5).expect("1 to 127");
/// assert_eq!(node.plus(0x700), CanId::standard(0x705));
/// assert!(NodeId::new(128).is_none());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(u8);

impl NodeId {
    /// Node ID 1, the default of most devices.
    pub const ONE: Self = Self(0);

    /// The node ID `raw`; `None` outside 1–127.
    pub const fn new(raw: u8) -> Option<Self> {
        if raw >= 1 && raw <= 127 {
            Some(Self(raw - 1))
        } else {
            None
        }
    }

    /// The number, 1–127.
    #[inline]
    pub const fn raw(self) -> u8 {
        self.0 + 1
    }

    /// The CAN-ID of the predefined connection set (CiA 301, chapter 7.3.3): four bits of
    /// function code, seven bits of node ID. `580h` is that of an SDO response.
    ///
    /// Only bits 7–10 of `function` are used, 080h to 780h, so that the CAN-ID has 11 bits.
    #[inline]
    pub const fn plus(self, function: u16) -> CanId {
        CanId::standard(function & 0x780 | self.raw() as u16)
    }
}

impl fmt::Display for NodeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.raw(), f)
    }
}

impl fmt::Debug for NodeId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.raw(), f)
    }
}

/// The value of a COB-ID object: identifier and its three flag bits
/// (CiA 301, objects 1005h, 1014h, 1400h, 1800h).
///
/// ```
/// use od_wire::{CanId, CobId};
///
/// let cob_id = CobId::new(0x4000_0185);
/// assert!(cob_id.is_valid() && !cob_id.allows_rtr());
/// assert_eq!(cob_id.can_id(), CanId::standard(0x185));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct CobId(u32);

impl CobId {
    /// The COB-ID of any value.
    pub const fn new(raw: u32) -> Self {
        Self(raw)
    }

    /// Returns the value.
    pub const fn raw(self) -> u32 {
        self.0
    }

    /// Returns whether bit 31 is clear: the PDO or EMCY message is valid.
    pub const fn is_valid(self) -> bool {
        self.0 & 1 << 31 == 0
    }

    /// Returns whether bit 30 is clear: a remote frame may request the PDO.
    pub const fn allows_rtr(self) -> bool {
        self.0 & 1 << 30 == 0
    }

    /// Returns whether bit 30 is set: in 1005h, the device produces SYNC.
    pub const fn produces_sync(self) -> bool {
        self.0 & 1 << 30 != 0
    }

    /// Returns whether bit 31 is set: in 1012h, the device consumes TIME.
    pub const fn consumes_time(self) -> bool {
        !self.is_valid()
    }

    /// Returns whether bit 30 is set: in 1012h, the device produces TIME.
    pub const fn produces_time(self) -> bool {
        self.produces_sync()
    }

    /// Returns the CAN-ID: 29 bits with bit 29 set, else 11.
    pub const fn can_id(self) -> CanId {
        if self.0 & 1 << 29 != 0 {
            CanId::extended(self.0)
        } else {
            CanId::standard(self.0 as u16)
        }
    }

    /// Returns the CAN-ID that a service may use: [`is_consistent`](Self::is_consistent), and not
    /// [restricted](Self::is_restricted) (CiA 301, table 40). `None`: a service with this COB-ID is not valid,
    /// whatever its flag bits.
    ///
    /// ```
    /// use od_wire::{CanId, CobId};
    ///
    /// assert_eq!(CobId::new(0x181).usable_id(), Some(CanId::standard(0x181)));
    /// assert_eq!(CobId::new(0x800).usable_id(), None); // its 11 bits are those of NMT
    /// assert_eq!(CobId::new(0x601).usable_id(), None); // a request of the default SDO
    /// ```
    pub const fn usable_id(self) -> Option<CanId> {
        if self.is_consistent() && !self.is_restricted() {
            Some(self.can_id())
        } else {
            None
        }
    }

    /// Returns whether bits 11 to 28, which belong to a 29-bit CAN-ID, are 0 while bit 29 is clear.
    pub const fn is_consistent(self) -> bool {
        self.0 & 1 << 29 != 0 || self.0 & 0x1FFF_F800 == 0
    }

    /// Returns whether the CAN-ID is restricted (CiA 301, chapter 7.3.5): it belongs to NMT, SDO, error control or LSS
    /// ([`od_model::is_restricted`]). No CAN-ID of 29 bits is restricted.
    pub const fn is_restricted(self) -> bool {
        match self.can_id().as_standard() {
            Some(id) => od_model::is_restricted(id as u32),
            None => false,
        }
    }
}

impl fmt::Debug for CobId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:08X}h", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cob_id_bits_are_those_of_cia_301() {
        let cob = CobId::new(0x4000_0181);
        assert!(cob.is_valid() && !cob.allows_rtr() && cob.is_consistent());
        assert_eq!(cob.can_id(), CanId::standard(0x181));
        assert_eq!(CobId::new(0x2001_0181).can_id(), CanId::extended(0x1_0181));
        assert!(!CobId::new(0x0000_0800).is_consistent());
        assert!(CobId::new(0x601).is_restricted() && !CobId::new(0x181).is_restricted());
        assert!(NodeId::new(0).is_none() && NodeId::new(128).is_none());
    }

    #[test]
    fn every_function_code_gives_an_11_bit_can_id() {
        let last = NodeId::new(127).unwrap();
        assert_eq!(last.plus(0x580), CanId::standard(0x5FF));
        assert_eq!(last.plus(0x780), CanId::standard(0x7FF));
        assert_eq!(last.plus(u16::MAX), CanId::standard(0x7FF));
        assert_eq!(NodeId::ONE.plus(0x5FF), CanId::standard(0x581));
    }
}
