//! The address of a value: index and sub-index.

use core::fmt;

/// Index and sub-index of one value, the multiplexer of CiA 301.
///
/// Ordered by index, then sub-index, as every table of this crate.
/// Shown as `1018h:02`.
///
/// ```
/// use od_model::Address;
///
/// let address = Address::new(0x1018, 4);
/// assert_eq!(address.to_string(), "1018h:04");
/// assert_eq!((address.index, address.sub), (0x1018, 4));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Address {
    /// Index, 0001h–FFFFh.
    pub index: u16,
    /// Sub-index, 00h–FFh; 00h for a VAR.
    pub sub: u8,
}

#[cfg(feature = "defmt")]
impl defmt::Format for Address {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{=u16:04X}h:{=u8:02X}", self.index, self.sub);
    }
}

impl Address {
    /// An address; every pair of index and sub-index is valid.
    pub const fn new(index: u16, sub: u8) -> Self {
        Self { index, sub }
    }

    /// Index and sub-index in one number with the same order: `index << 8 | sub`.
    #[inline]
    pub const fn key(self) -> u32 {
        (self.index as u32) << 8 | self.sub as u32
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04X}h:{:02X}", self.index, self.sub)
    }
}

impl fmt::Debug for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
