//! Data types and object codes (CiA 301 chapter 7.4, CiA 306-1).

use core::fmt;

/// The static data types of CiA 301 (table 44, object indices 0001h–001Bh) and
/// the predefined records 0020h–0023h.
///
/// ```
/// use od_model::DataType;
///
/// assert_eq!(DataType::from_code(0x0007), Some(DataType::Unsigned32));
/// assert_eq!((DataType::Unsigned24.name(), DataType::Unsigned24.bits()), ("UNSIGNED24", Some(24)));
/// assert_eq!(DataType::Integer8.integer_range(), Some((-128, 127)));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[repr(u16)]
#[allow(missing_docs)] // the variants are the standard's own names
pub enum DataType {
    Boolean = 0x01,
    Integer8 = 0x02,
    Integer16 = 0x03,
    Integer32 = 0x04,
    Unsigned8 = 0x05,
    Unsigned16 = 0x06,
    Unsigned32 = 0x07,
    Real32 = 0x08,
    VisibleString = 0x09,
    OctetString = 0x0A,
    UnicodeString = 0x0B,
    TimeOfDay = 0x0C,
    TimeDifference = 0x0D,
    Domain = 0x0F,
    Integer24 = 0x10,
    Real64 = 0x11,
    Integer40 = 0x12,
    Integer48 = 0x13,
    Integer56 = 0x14,
    Integer64 = 0x15,
    Unsigned24 = 0x16,
    Unsigned40 = 0x18,
    Unsigned48 = 0x19,
    Unsigned56 = 0x1A,
    Unsigned64 = 0x1B,
    PdoCommunicationParameter = 0x20,
    PdoMapping = 0x21,
    SdoParameter = 0x22,
    Identity = 0x23,
}

/// Meaning of the bytes of a value.
///
/// ```
/// use od_model::{DataType, Kind};
///
/// assert_eq!(DataType::Integer40.kind(), Kind::Signed);
/// assert_eq!(DataType::VisibleString.kind(), Kind::Text);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// One bit in a PDO, one byte in an SDO: 0 or 1.
    Boolean,
    /// Little-endian, no sign; also the 48-bit times.
    Unsigned,
    /// Little-endian two's complement.
    Signed,
    /// IEEE 754.
    Real,
    /// ISO 646 text of any length.
    Text,
    /// Bytes without further meaning, of any length.
    Bytes,
    /// A record; its sub-objects have the values.
    Record,
}

impl DataType {
    /// Every type, in the order of its code.
    pub const ALL: [DataType; 29] = {
        use DataType::*;
        [
            Boolean,
            Integer8,
            Integer16,
            Integer32,
            Unsigned8,
            Unsigned16,
            Unsigned32,
            Real32,
            VisibleString,
            OctetString,
            UnicodeString,
            TimeOfDay,
            TimeDifference,
            Domain,
            Integer24,
            Real64,
            Integer40,
            Integer48,
            Integer56,
            Integer64,
            Unsigned24,
            Unsigned40,
            Unsigned48,
            Unsigned56,
            Unsigned64,
            PdoCommunicationParameter,
            PdoMapping,
            SdoParameter,
            Identity,
        ]
    };

    /// Returns the type with this code, the index of its DEFTYPE object; `None` for other codes.
    pub const fn from_code(code: u16) -> Option<Self> {
        let mut i = 0;
        while i < Self::ALL.len() {
            if Self::ALL[i] as u16 == code {
                return Some(Self::ALL[i]);
            }
            i += 1;
        }
        None
    }

    /// Index of the type's DEFTYPE or DEFSTRUCT object: 0001h–0023h.
    pub const fn code(self) -> u16 {
        self as u16
    }

    /// The standard's name, for example `UNSIGNED32`.
    pub const fn name(self) -> &'static str {
        use DataType::*;
        match self {
            Boolean => "BOOLEAN",
            Integer8 => "INTEGER8",
            Integer16 => "INTEGER16",
            Integer24 => "INTEGER24",
            Integer32 => "INTEGER32",
            Integer40 => "INTEGER40",
            Integer48 => "INTEGER48",
            Integer56 => "INTEGER56",
            Integer64 => "INTEGER64",
            Unsigned8 => "UNSIGNED8",
            Unsigned16 => "UNSIGNED16",
            Unsigned24 => "UNSIGNED24",
            Unsigned32 => "UNSIGNED32",
            Unsigned40 => "UNSIGNED40",
            Unsigned48 => "UNSIGNED48",
            Unsigned56 => "UNSIGNED56",
            Unsigned64 => "UNSIGNED64",
            Real32 => "REAL32",
            Real64 => "REAL64",
            VisibleString => "VISIBLE_STRING",
            OctetString => "OCTET_STRING",
            UnicodeString => "UNICODE_STRING",
            TimeOfDay => "TIME_OF_DAY",
            TimeDifference => "TIME_DIFFERENCE",
            Domain => "DOMAIN",
            PdoCommunicationParameter => "PDO_COMMUNICATION_PARAMETER",
            PdoMapping => "PDO_MAPPING",
            SdoParameter => "SDO_PARAMETER",
            Identity => "IDENTITY",
        }
    }

    /// Length in a PDO, in bits; `None` if it varies, or if the type is a record.
    pub const fn bits(self) -> Option<u8> {
        use DataType::*;
        Some(match self {
            Boolean => 1,
            Integer8 | Unsigned8 => 8,
            Integer16 | Unsigned16 => 16,
            Integer24 | Unsigned24 => 24,
            Integer32 | Unsigned32 | Real32 => 32,
            Integer40 | Unsigned40 => 40,
            Integer48 | Unsigned48 | TimeOfDay | TimeDifference => 48,
            Integer56 | Unsigned56 => 56,
            Integer64 | Unsigned64 | Real64 => 64,
            VisibleString | OctetString | UnicodeString | Domain => return None,
            PdoCommunicationParameter | PdoMapping | SdoParameter | Identity => return None,
        })
    }

    /// Length in an SDO, in bytes; `None` as for [`bits`](Self::bits).
    pub const fn size(self) -> Option<usize> {
        match self.bits() {
            Some(bits) => Some(bits.div_ceil(8) as usize),
            None => None,
        }
    }

    /// Returns the meaning of the bytes.
    pub const fn kind(self) -> Kind {
        use DataType::*;
        match self {
            Boolean => Kind::Boolean,
            Integer8 | Integer16 | Integer24 | Integer32 | Integer40 | Integer48 | Integer56
            | Integer64 => Kind::Signed,
            Unsigned8 | Unsigned16 | Unsigned24 | Unsigned32 | Unsigned40 | Unsigned48
            | Unsigned56 | Unsigned64 | TimeOfDay | TimeDifference => Kind::Unsigned,
            Real32 | Real64 => Kind::Real,
            VisibleString => Kind::Text,
            OctetString | UnicodeString | Domain => Kind::Bytes,
            PdoCommunicationParameter | PdoMapping | SdoParameter | Identity => Kind::Record,
        }
    }

    /// Returns whether a default value can depend on the node ID: UNSIGNED8 to UNSIGNED32.
    pub const fn holds_node_id(self) -> bool {
        use DataType::*;
        matches!(self, Unsigned8 | Unsigned16 | Unsigned24 | Unsigned32)
    }

    /// Returns smallest and largest value of an integer type or BOOLEAN; `None` for other types.
    pub const fn integer_range(self) -> Option<(i128, i128)> {
        match (self.kind(), self.bits()) {
            (Kind::Boolean, _) => Some((0, 1)),
            (Kind::Unsigned, Some(bits)) => Some((0, (1i128 << bits) - 1)),
            (Kind::Signed, Some(bits)) => Some((-(1i128 << (bits - 1)), (1i128 << (bits - 1)) - 1)),
            _ => None,
        }
    }
}

impl fmt::Display for DataType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Object codes of CiA 301 (table 42).
///
/// ```
/// use od_model::ObjectCode;
///
/// assert_eq!(ObjectCode::from_code(9), Some(ObjectCode::Record));
/// assert!(ObjectCode::Record.has_members() && !ObjectCode::Var.has_members());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[repr(u8)]
#[allow(missing_docs)] // the variants are the standard's own names
pub enum ObjectCode {
    Null = 0x00,
    Domain = 0x02,
    DefType = 0x05,
    DefStruct = 0x06,
    #[default]
    Var = 0x07,
    Array = 0x08,
    Record = 0x09,
}

impl ObjectCode {
    /// Returns the object code with this number; `None` for other numbers.
    pub const fn from_code(code: u8) -> Option<Self> {
        Some(match code {
            0x00 => Self::Null,
            0x02 => Self::Domain,
            0x05 => Self::DefType,
            0x06 => Self::DefStruct,
            0x07 => Self::Var,
            0x08 => Self::Array,
            0x09 => Self::Record,
            _ => return None,
        })
    }

    /// The standard's number.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The standard's name, for example `RECORD`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Null => "NULL",
            Self::Domain => "DOMAIN",
            Self::DefType => "DEFTYPE",
            Self::DefStruct => "DEFSTRUCT",
            Self::Var => "VAR",
            Self::Array => "ARRAY",
            Self::Record => "RECORD",
        }
    }

    /// Returns whether the object has sub-objects, with their number in sub-index 0.
    pub const fn has_members(self) -> bool {
        matches!(self, Self::Array | Self::Record | Self::DefStruct)
    }
}

impl fmt::Display for ObjectCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_gives_its_type() {
        for t in DataType::ALL {
            assert_eq!(DataType::from_code(t.code()), Some(t));
        }
        for code in [0x00, 0x0E, 0x17, 0x1C, 0x1F, 0x24, 0xFFFF] {
            assert_eq!(DataType::from_code(code), None, "{code:#x}");
        }
        for code in 0..=0xFF {
            assert!(ObjectCode::from_code(code).is_none_or(|c| c.code() == code));
        }
    }

    #[test]
    fn sizes_and_ranges_are_those_of_cia_301() {
        assert_eq!(DataType::Boolean.size(), Some(1));
        assert_eq!(DataType::Unsigned24.size(), Some(3));
        assert_eq!(DataType::TimeOfDay.bits(), Some(48));
        assert_eq!(DataType::VisibleString.bits(), None);
        assert_eq!(DataType::Integer8.integer_range(), Some((-128, 127)));
        assert_eq!(
            DataType::Unsigned64.integer_range(),
            Some((0, u64::MAX as i128))
        );
        assert_eq!(DataType::Real32.integer_range(), None);
    }
}
