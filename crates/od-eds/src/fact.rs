//! The content of a sentence: facts of a finding, and keys.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use od_model::{Access, Address, DataType, ObjectCode};

use crate::description::Value;

/// A key of an object's section in an EDS, which is a field of a row in a macro call.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[allow(missing_docs)] // the variants are the keys' names
#[non_exhaustive]
pub enum Key {
    ParameterName,
    ObjectType,
    SubNumber,
    CompactSubObj,
    DataType,
    AccessType,
    PdoMapping,
    DefaultValue,
    ParameterValue,
    LowLimit,
    HighLimit,
    ObjFlags,
    /// CANopenEditor's comment `;StorageLocation=`.
    StorageLocation,
    /// Memory for a string or DOMAIN in the store: a field of a macro call, not a key of an EDS.
    Capacity,
}

impl Key {
    /// The keys of an EDS.
    pub const ALL: [Self; 13] = [
        Self::ParameterName,
        Self::ObjectType,
        Self::SubNumber,
        Self::CompactSubObj,
        Self::DataType,
        Self::AccessType,
        Self::PdoMapping,
        Self::DefaultValue,
        Self::ParameterValue,
        Self::LowLimit,
        Self::HighLimit,
        Self::ObjFlags,
        Self::StorageLocation,
    ];

    /// The key as an EDS writes it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ParameterName => "ParameterName",
            Self::ObjectType => "ObjectType",
            Self::SubNumber => "SubNumber",
            Self::CompactSubObj => "CompactSubObj",
            Self::DataType => "DataType",
            Self::AccessType => "AccessType",
            Self::PdoMapping => "PDOMapping",
            Self::DefaultValue => "DefaultValue",
            Self::ParameterValue => "ParameterValue",
            Self::LowLimit => "LowLimit",
            Self::HighLimit => "HighLimit",
            Self::ObjFlags => "ObjFlags",
            Self::StorageLocation => "StorageLocation",
            Self::Capacity => "Capacity",
        }
    }

    /// Returns whether the text is its name, in any case.
    pub fn is(self, name: &str) -> bool {
        self.name().eq_ignore_ascii_case(name)
    }

    /// Returns whether its value is a number or a word of CiA 306, not a text.
    pub(crate) const fn is_coded(self) -> bool {
        matches!(
            self,
            Self::ObjectType
                | Self::SubNumber
                | Self::CompactSubObj
                | Self::DataType
                | Self::AccessType
                | Self::PdoMapping
                | Self::ObjFlags
        )
    }

    /// The key with this name, written as in the standard.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|key| key.name() == name)
    }
}

/// One fact of a finding, which fills a blank of its sentence.
#[derive(Clone, PartialEq, Debug)]
pub enum Fact {
    /// A number or a count.
    Number(i128),
    /// A default, a limit or a configured value.
    Value(Value),
    /// A data type.
    Type(DataType),
    /// The form of a value of this type.
    FormOf(DataType),
    /// An object code.
    Code(ObjectCode),
    /// An access type.
    Access(Access),
    /// An object, by its index.
    Index(u16),
    /// A value of an object.
    Object(Address),
    /// A section to write: of an object, or of one of its sub-indices.
    Section(u16, Option<u8>),
    /// A key.
    Key(Key),
    /// Text of the file, or a word.
    Text(String),
    /// Several facts, with commas between them.
    List(Vec<Fact>),
    /// Several facts, of which one is enough.
    OneOf(Vec<Fact>),
}

impl Fact {
    /// The index of the object that the fact is about, if there is one.
    pub fn index(&self) -> Option<u16> {
        match self {
            Self::Index(index) | Self::Section(index, _) => Some(*index),
            Self::Object(address) => Some(address.index),
            _ => None,
        }
    }

    /// Returns whether it, or one of several facts in it, is about an object of these.
    pub(crate) fn is_about(&self, objects: &dyn Fn(u16) -> bool) -> bool {
        match self {
            Self::List(facts) | Self::OneOf(facts) => {
                facts.iter().any(|fact| fact.is_about(objects))
            }
            fact => fact.index().is_some_and(objects),
        }
    }
}

macro_rules! facts {
    ($($variant:ident($t:ty))*) => {$(
        impl From<$t> for Fact {
            fn from(value: $t) -> Self {
                Self::$variant(value.into())
            }
        }
    )*};
}

facts! {
    Number(i128) Number(i64) Number(u64) Number(u32) Number(u16) Number(u8)
    Value(Value) Type(DataType) Code(ObjectCode) Access(Access)
    Object(Address) Key(Key) List(Vec<Fact>)
}

/// Maximum number of characters of a text of the file in a sentence.
pub(crate) const LONGEST: usize = 100;

impl From<&str> for Fact {
    /// A text of the file: as much of it as a sentence can show, and one character more if it is longer.
    fn from(text: &str) -> Self {
        let end = text.char_indices().nth(LONGEST + 1);
        Self::Text(text[..end.map_or(text.len(), |(at, _)| at)].into())
    }
}

impl From<String> for Fact {
    fn from(text: String) -> Self {
        text.as_str().into()
    }
}

impl From<usize> for Fact {
    fn from(count: usize) -> Self {
        // The number of items in memory fits.
        Self::Number(count as i128)
    }
}

/// A value in the spelling of an EDS.
pub fn shown(value: &Value) -> String {
    match value {
        Value::Unsigned(v) => v.to_string(),
        Value::Signed(v) => v.to_string(),
        Value::Real(v) => format!("{v:?}"),
        Value::NodeId(0) => "$NODEID".into(),
        Value::NodeId(offset) => format!("$NODEID+0x{offset:X}"),
        Value::Text(text) => format!("{text:?}"),
        Value::Bytes(_) => "bytes".into(),
    }
}
