//! The rows of a dictionary's tables: objects and entries.

use core::fmt;

use crate::access::{Access, Group};
use crate::address::Address;
use crate::types::{DataType, Kind, ObjectCode};
use crate::value::{Literal, Range};

/// One object: its index, its name and the range of its entries.
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// use od_model::ObjectCode;
///
/// let dictionary = tables.dictionary();
/// let identity = dictionary.object(0x1018).expect("each device has one");
/// assert_eq!(identity.code, ObjectCode::Record);
/// assert_eq!(dictionary.members(&identity).count(), usize::from(identity.count));
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Object {
    /// Index.
    pub index: u16,
    /// VAR, ARRAY, RECORD …
    pub code: ObjectCode,
    /// The object's name, in [`Dictionary::text`](crate::Dictionary::text).
    pub name: Range,
    /// Position of the object's first entry in [`Dictionary::entries`](crate::Dictionary::entries).
    pub first: u32,
    /// Number of entries; 1 for a VAR.
    pub count: u16,
}

/// One value of an object: the data behind one multiplexer (CiA 301, chapter 7.4).
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// use od_model::{Access, DataType};
///
/// let position = tables.dictionary().entry(0x6004, 0).expect("an encoder has a position");
/// assert_eq!((position.data_type, position.access), (DataType::Unsigned32, Access::Ro));
/// assert!(position.maps_to_tpdo() && !position.maps_to_rpdo());
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Entry {
    /// Index and sub-index.
    pub address: Address,
    /// Data type; never one of the records.
    pub data_type: DataType,
    /// Access from the bus.
    pub access: Access,
    /// PDOMapping of the EDS: the value may be mapped into PDOs in the direction that the access allows.
    pub mappable: bool,
    /// The sub-index of 1010h that saves the value.
    pub group: Group,
    /// The entry's name, in [`Dictionary::text`](crate::Dictionary::text).
    pub name: Range,
    /// Value after reset without a saved one.
    pub default: Literal,
    /// LowLimit; `Literal::None` if only the data type limits the value.
    pub low: Literal,
    /// HighLimit; `Literal::None` if only the data type limits the value.
    pub high: Literal,
    /// Place of the value in the store.
    pub slot: Slot,
}

/// Place of a value in the caller's store.
///
/// A fixed-size value takes `len` bytes, little-endian. A string takes `len`
/// bytes too: two for the current length, the rest is capacity. `len` 0 means
/// that nothing is stored and the default is the value (access `const`).
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// let dictionary = tables.dictionary();
/// let slot = dictionary.entry(0x1017, 0).expect("the heartbeat time").slot;
/// assert_eq!(slot.len, 2);
/// assert!(slot.offset as usize + 2 <= dictionary.store_len());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Slot {
    /// First byte.
    pub offset: u32,
    /// Number of bytes.
    pub len: u16,
}

impl Slot {
    /// Nothing is stored.
    #[doc(hidden)]
    pub const NONE: Self = Self { offset: 0, len: 0 };
}

/// Reason why an address has no entry.
///
/// ```
/// # let description = od_eds::parse(include_str!("../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// use od_model::{Address, Missing};
///
/// let find = |index, sub| tables.dictionary().find(Address::new(index, sub)).map(|entry| entry.address);
/// assert_eq!(find(0x5FFF, 0), Err(Missing::Object));
/// assert_eq!(find(0x1018, 9), Err(Missing::SubIndex));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Missing {
    /// No object with this index: SDO abort 06020000h.
    Object,
    /// The object has no such sub-index: SDO abort 06090011h.
    SubIndex,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Object => "the object does not exist",
            Self::SubIndex => "the object does not have this sub-index",
        })
    }
}

impl core::error::Error for Missing {}

impl Entry {
    /// Returns whether the value may be mapped into a TPDO.
    pub const fn maps_to_tpdo(&self) -> bool {
        self.mappable && self.access.maps_to_tpdo()
    }

    /// Returns whether the value may be mapped into an RPDO.
    pub const fn maps_to_rpdo(&self) -> bool {
        self.mappable && self.access.maps_to_rpdo()
    }

    /// Returns whether the length varies (strings, domains) instead of following from the type.
    pub const fn is_variable(&self) -> bool {
        matches!(self.data_type.kind(), Kind::Text | Kind::Bytes)
    }
}
