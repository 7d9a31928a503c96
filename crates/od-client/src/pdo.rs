//! Decodes PDOs by their mapping (CiA 301, chapters 7.2.2 and 7.4.9).

use core::fmt;

use od_model::typed::MapEntry;
use od_model::{Address, DataType, Dictionary, Entry, Literal};

/// The data of a PDO is shorter than its mapping.
///
/// ```
/// use od_client::pdo::{TooShort, decode};
/// use od_model::Dictionary;
///
/// let received = decode(&Dictionary::EMPTY, &[0x6004_0020], &[1, 2]).map(|_| ());
/// assert_eq!(received, Err(TooShort { mapped: 32, received: 16 }));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct TooShort {
    /// Bits of the mapping.
    pub mapped: u32,
    /// Bits of the data.
    pub received: u32,
}

impl fmt::Display for TooShort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mapped, received } = self;
        write!(f, "the PDO has {received} bits, but its mapping {mapped}")
    }
}

impl core::error::Error for TooShort {}

/// One mapped value in a PDO.
///
/// ```
/// use od_client::pdo::decode;
/// use od_model::{Address, Dictionary};
///
/// let mut fields = decode(&Dictionary::EMPTY, &[0x6030_0110], &[0xFE, 0xFF]).expect("16 bits");
/// let speed = fields.next().expect("one entry");
/// assert_eq!((speed.address, speed.signed()), (Address::new(0x6030, 1), -2));
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Field {
    /// The mapped object. One below 0020h is a dummy entry: a data type that fills a gap.
    pub address: Address,
    /// The object's entry; `None` if the dictionary has none.
    pub entry: Option<Entry>,
    /// Position of the lowest bit in the PDO, 0 to 63.
    pub first: u8,
    /// Length in bits, 0 to 64.
    pub bits: u8,
    value: u64,
}

impl Field {
    /// The bits as an unsigned number.
    pub const fn unsigned(&self) -> u64 {
        self.value
    }

    /// The bits as a two's complement number of [`bits`](Self::bits) bits.
    pub const fn signed(&self) -> i64 {
        match 64 - self.bits as u32 {
            64 => 0,
            shift => ((self.value << shift) as i64) >> shift,
        }
    }

    /// The bits as little-endian bytes, as in an SDO; the first
    /// [`len`](Self::len) count.
    pub const fn bytes(&self) -> [u8; 8] {
        self.value.to_le_bytes()
    }

    /// Length in bytes, 0 to 8; a field of 1 bit has 1 byte.
    pub const fn len(&self) -> usize {
        self.bits.div_ceil(8) as usize
    }

    /// Returns whether the field has no bits.
    pub const fn is_empty(&self) -> bool {
        self.bits == 0
    }

    /// Returns whether the field only fills a gap (dummy mapping of CiA 301, chapter 7.4.7).
    pub const fn is_dummy(&self) -> bool {
        self.address.index < 0x20
    }

    /// The type of the object, or of the dummy entry.
    pub fn data_type(&self) -> Option<DataType> {
        match self.entry {
            Some(entry) => Some(entry.data_type),
            None => DataType::from_code(self.address.index),
        }
    }
}

/// The bits of a PDO from `first` on, as an unsigned number; `None` if the data ends before the last of them, and for
/// 0 or more than 64 bits.
pub fn bits(data: &[u8], first: u8, bits: u8) -> Option<u64> {
    let end = u32::from(first) + u32::from(bits);
    if !(1..=64).contains(&bits) || end > 8 * data.len().min(8) as u32 {
        return None;
    }
    let number = |value, byte: &u8| value << 8 | u64::from(*byte);
    let value = data.iter().take(8).rev().fold(0, number);
    Some(value >> first & (u64::MAX >> (64 - bits)))
}

/// Decodes the data of a PDO.
///
/// `mapping` are the mapping entries, 1600h:01 or 1A00h:01 and so on, as many as sub-index 0
/// counts. Bytes after the mapped ones are ignored (CiA 301, chapter 7.2.2.5), as are bytes after
/// the eighth.
///
/// # Errors
/// [`TooShort`] if the data has fewer bits than the mapping.
///
/// ```
/// # use od_model::Dictionary;
/// use od_client::pdo;
/// # let dictionary = Dictionary::EMPTY;
///
/// let mapping = [0x6000_0001, 0x6001_0003, 0x6002_000C];
/// let fields = pdo::decode(&dictionary, &mapping, &[0b1010_1011, 0xCD]).expect("16 bits");
/// let values: Vec<u64> = fields.map(|field| field.unsigned()).collect();
/// assert_eq!(values, [0b1, 0b101, 0xCDA]);
/// ```
pub fn decode<'d, 'm>(
    dictionary: &Dictionary<'d>,
    mapping: &'m [u32],
    data: &[u8],
) -> Result<Fields<'d, 'm>, TooShort> {
    let mut bytes = [0; 8];
    let len = data.len().min(8);
    bytes[..len].copy_from_slice(&data[..len]);
    let bits = mapping.iter().map(|raw| raw & 0xFF);
    let mapped = bits.fold(0, u32::saturating_add);
    let received = len as u32 * 8;
    if mapped > received {
        return Err(TooShort { mapped, received });
    }
    Ok(Fields {
        dictionary: *dictionary,
        mapping: mapping.iter(),
        data: u64::from_le_bytes(bytes),
        first: 0,
    })
}

/// The values of a PDO, in the order of the mapping; [`decode`] returns it.
///
/// ```
/// use od_client::pdo::decode;
/// use od_model::Dictionary;
///
/// let fields = decode(&Dictionary::EMPTY, &[0x6004_0020, 0x6030_0110], &[1, 0, 0, 0, 2, 0]).expect("48 bits");
/// assert_eq!(fields.map(|field| field.unsigned()).collect::<Vec<_>>(), [1, 2]);
/// ```
#[derive(Clone, Debug)]
pub struct Fields<'d, 'm> {
    dictionary: Dictionary<'d>,
    mapping: core::slice::Iter<'m, u32>,
    data: u64,
    /// Bits before the next field; at most 64, as `decode` has checked.
    first: u8,
}

impl Iterator for Fields<'_, '_> {
    type Item = Field;

    fn next(&mut self) -> Option<Field> {
        let MapEntry { address, bits } = MapEntry::parse(*self.mapping.next()?);
        let first = self.first;
        let rest = self.data.checked_shr(first.into()).unwrap_or(0);
        let mask = u64::MAX.checked_shr(64 - u32::from(bits.min(64)));
        self.first = first.saturating_add(bits);
        Some(Field {
            address,
            entry: self.dictionary.find(address).ok(),
            first,
            bits,
            value: rest & mask.unwrap_or(0),
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.mapping.size_hint()
    }
}

impl ExactSizeIterator for Fields<'_, '_> {}

/// The mapping entries of a dictionary.
///
/// ```
/// use od_client::pdo::Mapping;
///
/// # let description = od_eds::parse(include_str!("../../../devices/eds/GXMM.eds")).description;
/// # let tables = od_eds::Tables::new(&description);
/// // 1A00h: what the device sends in TPDO1 by default.
/// let mapping = Mapping::of(&tables.dictionary(), 0x1A00).expect("the device has a TPDO");
/// assert_eq!(mapping.entries(), [0x6004_0020]);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Mapping {
    entries: [u32; 64],
    len: usize,
}

impl Mapping {
    /// The default mapping of a PDO: the default values of the mapping object `index` (1600h to
    /// 17FFh, 1A00h to 1BFFh), as many as its sub-index 0 counts, 64 at most. `None` if the
    /// dictionary does not have them all.
    pub fn of(dictionary: &Dictionary<'_>, index: u16) -> Option<Self> {
        let default = |sub| match dictionary.entry(index, sub)?.default {
            Literal::Unsigned(value) => u32::try_from(value).ok(),
            _ => None,
        };
        let mut mapping = Self {
            entries: [0; 64],
            len: default(0)? as usize,
        };
        let entries = mapping.entries.get_mut(..mapping.len)?;
        for (sub, entry) in (1..).zip(entries) {
            *entry = default(sub)?;
        }
        Some(mapping)
    }

    /// The mapping entries, for [`decode`].
    pub fn entries(&self) -> &[u32] {
        self.entries.get(..self.len).unwrap_or_default()
    }
}
