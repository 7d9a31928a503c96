//! SDO abort codes.

use core::fmt;

use od_model::Missing;

macro_rules! abort_codes {
    ($($(#[$doc:meta])* $name:ident = $code:literal, $text:literal;)*) => {
        /// SDO abort code (CiA 301, chapter 7.2.4.3.17), stored as its position in [`ALL`](Self::ALL);
        /// [`code`](Self::code) returns the value on the bus.
        ///
        /// ```
        /// use od_wire::AbortCode;
        ///
        /// assert_eq!(AbortCode::from_code(0x0602_0000), Some(AbortCode::NoObject));
        /// assert_eq!(AbortCode::ReadOnly.code(), 0x0601_0002);
        /// ```
        // A small number needs one short instruction. As a word, a code and a pointer can be
        // returned in registers.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        #[repr(u32)]
        #[non_exhaustive]
        pub enum AbortCode { $(#[doc = $text] $(#[$doc])* $name,)* }

        impl AbortCode {
            /// Every code, by ascending number.
            pub const ALL: &[AbortCode] = &[$(AbortCode::$name),*];

            /// Returns the abort code with this value; `None` for a value that CiA 301 does not define.
            pub const fn from_code(code: u32) -> Option<Self> {
                match code { $($code => Some(Self::$name),)* _ => None }
            }

            /// The value on the bus.
            pub const fn code(self) -> u32 {
                let short = self.short() as u32;
                short << 12 & 0xF00_0000 | short << 8 & 0xF_0000 | short & 0xFF
            }

            // The call makes the compiler generate a table.
            const fn short(self) -> u16 {
                match self { $(Self::$name => const { short($code) },)* }
            }

            /// Returns a short English description.
            pub const fn text(self) -> &'static str {
                match self { $(Self::$name => $text),* }
            }
        }

        #[cfg(feature = "defmt")]
        impl defmt::Format for AbortCode {
            fn format(&self, f: defmt::Formatter<'_>) {
                let text = match self { $(Self::$name => defmt::intern!($text)),* };
                defmt::write!(f, "{=u32:08X}h {=istr}", self.code(), text);
            }
        }
    };
}

abort_codes! {
    ToggleBit = 0x0503_0000, "toggle bit did not alternate";
    Timeout = 0x0504_0000, "SDO transfer timed out";
    InvalidCommand = 0x0504_0001, "command specifier unknown or out of turn";
    InvalidBlockSize = 0x0504_0002, "block size out of range";
    InvalidSequence = 0x0504_0003, "block sequence number wrong";
    Crc = 0x0504_0004, "block checksum wrong";
    OutOfMemory = 0x0504_0005, "no memory left for the transfer";
    UnsupportedAccess = 0x0601_0000, "object cannot be accessed like this";
    WriteOnly = 0x0601_0001, "object is write only";
    ReadOnly = 0x0601_0002, "object is read only";
    SubZeroFirst = 0x0601_0003, "sub-index 0 must be 0 before members change";
    NoObject = 0x0602_0000, "object does not exist";
    NotMappable = 0x0604_0041, "object cannot be mapped into a PDO";
    PdoTooLong = 0x0604_0042, "mapping exceeds the PDO length";
    Incompatible = 0x0604_0043, "parameters do not go together";
    DeviceIncompatible = 0x0604_0047, "device cannot do this internally";
    Hardware = 0x0606_0000, "hardware error while accessing the object";
    Length = 0x0607_0010, "length does not match the data type";
    TooLong = 0x0607_0012, "data longer than the object";
    TooShort = 0x0607_0013, "data shorter than the object";
    NoSubIndex = 0x0609_0011, "sub-index does not exist";
    ValueRange = 0x0609_0030, "value not allowed";
    ValueTooHigh = 0x0609_0031, "value above the upper limit";
    ValueTooLow = 0x0609_0032, "value below the lower limit";
    MaximumBelowMinimum = 0x0609_0036, "maximum below minimum";
    NoResource = 0x060A_0023, "resource not available";
    General = 0x0800_0000, "general error";
    NotStored = 0x0800_0020, "data cannot be transferred or stored";
    LocalControl = 0x0800_0021, "data cannot be stored because of local control";
    DeviceState = 0x0800_0022, "not in the present device state";
    NoDictionary = 0x0800_0023, "object dictionary missing or not generated";
    NoData = 0x0800_0024, "no data available";
}

/// A code without the digits that are 0 in all codes.
const fn short(code: u32) -> u16 {
    assert!(code & !0xF0F_00FF == 0, "a digit that no abort code has");
    (code >> 12 & 0xF000 | code >> 8 & 0xF00 | code & 0xFF) as u16
}

impl fmt::Display for AbortCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:08X}h {}", self.code(), self.text())
    }
}

impl core::error::Error for AbortCode {}

impl From<Missing> for AbortCode {
    #[inline]
    fn from(missing: Missing) -> Self {
        match missing {
            Missing::Object => Self::NoObject,
            Missing::SubIndex => Self::NoSubIndex,
        }
    }
}

/// Reason of an SDO abort, by the 32-bit abort code in the frame (CiA 301, table 22). Profiles and manufacturers define
/// codes that this table does not have.
///
/// Shown as the number and its [`text`](Self::text).
///
/// ```
/// use od_wire::AbortReason;
///
/// assert_eq!(AbortReason(0x0602_0000).to_string(), "06020000h object does not exist");
/// let other = "0609002Ah value or sub-index is refused (CiA 301 does not define the code)";
/// assert_eq!(AbortReason(0x0609_002A).to_string(), other);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct AbortReason(pub u32);

impl AbortReason {
    /// Returns a short English description; for a code that CiA 301 does not define, that of its class, which the
    /// first two bytes give (5: protocol, 6: access, 8: other).
    pub const fn text(self) -> &'static str {
        match AbortCode::from_code(self.0) {
            Some(code) => code.text(),
            None => self.class(),
        }
    }

    const fn class(self) -> &'static str {
        match self.0 >> 16 {
            0x0500..=0x05FF => "error of the SDO protocol (CiA 301 does not define the code)",
            0x0602 => "object or its content does not exist (CiA 301 does not define the code)",
            0x0604 => "parameters do not go together (CiA 301 does not define the code)",
            0x0606 => "hardware error (CiA 301 does not define the code)",
            0x0607 => "type or length does not match (CiA 301 does not define the code)",
            0x0609 => "value or sub-index is refused (CiA 301 does not define the code)",
            0x060A => "resource not available (CiA 301 does not define the code)",
            0x0600..=0x06FF => "access is refused (CiA 301 does not define the code)",
            0x0800..=0x08FF => {
                "error of the device or its application (CiA 301 does not define the code)"
            }
            _ => "code of a device profile or of the manufacturer (CiA 301 does not define it)",
        }
    }
}

impl fmt::Display for AbortReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:08X}h {}", self.0, self.text())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_found_and_none_is_listed_twice() {
        for (i, code) in AbortCode::ALL.iter().enumerate() {
            assert_eq!(AbortCode::from_code(code.code()), Some(*code));
            assert!(i == 0 || AbortCode::ALL[i - 1].code() < code.code());
        }
        assert_eq!(AbortCode::from_code(0x0602_0001), None);
    }
}
