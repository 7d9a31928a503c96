//! One difference between two dictionaries, as data.

use alloc::string::{String, ToString};

use od_model::{Address, Visible};

/// Whether a master that was configured for the first device works with the second.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "lowercase")
)]
pub enum Impact {
    /// It works.
    Compatible,
    /// It may fail, or read an unexpected value.
    Breaking,
}

/// The property of an object or an entry that differs.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(rename_all = "kebab-case")
)]
pub enum Field {
    /// Only the second dictionary has the object.
    ObjectAdded,
    /// Only the first dictionary has the object.
    ObjectRemoved,
    /// Only the second dictionary has the sub-object.
    EntryAdded,
    /// Only the first dictionary has the sub-object.
    EntryRemoved,
    /// VAR, ARRAY, RECORD …
    ObjectCode,
    /// ParameterName.
    Name,
    /// DataType.
    DataType,
    /// AccessType.
    Access,
    /// PDOMapping: in which direction it can be mapped.
    Mapping,
    /// DefaultValue.
    Default,
    /// LowLimit.
    LowLimit,
    /// HighLimit.
    HighLimit,
    /// Group of 1010h that saves it.
    Storage,
    /// The node violates the protocol in the transfer of the value, or does not respond to its request.
    Transfer,
}

impl Field {
    /// In words, for a table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ObjectAdded | Self::EntryAdded => "added",
            Self::ObjectRemoved | Self::EntryRemoved => "removed",
            Self::ObjectCode => "object type",
            Self::Name => "name",
            Self::DataType => "data type",
            Self::Access => "access",
            Self::Mapping => "PDO mapping",
            Self::Default => "default",
            Self::LowLimit => "low limit",
            Self::HighLimit => "high limit",
            Self::Storage => "storage",
            Self::Transfer => "SDO transfer",
        }
    }
}

/// One difference.
#[derive(Clone, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Difference {
    /// Index.
    pub index: u16,
    /// Sub-index; `None` for a whole object, and always for a VAR.
    pub sub: Option<u8>,
    /// Name of the entry or object; that of the second dictionary if it has one.
    pub name: String,
    /// Property that differs.
    pub field: Field,
    /// Value in the first dictionary; empty if missing.
    pub before: String,
    /// Value in the second dictionary; empty if missing.
    pub after: String,
    /// Impact on a master.
    pub impact: Impact,
}

impl Difference {
    /// `6001h`, or `1018h:02` for one of several entries.
    pub fn place(&self) -> String {
        match self.sub {
            Some(sub) => Address::new(self.index, sub).to_string(),
            None => alloc::format!("{:04X}h", self.index),
        }
    }

    /// `default 0 -> 5`, `added, VAR of 1 entry`: the change in words.
    pub fn change(&self) -> String {
        let shown = |text: &str| match text {
            "" => String::from("nothing"),
            text => Visible(text).line().into_owned(),
        };
        let (before, after) = (shown(&self.before), shown(&self.after));
        match self.field {
            Field::ObjectAdded | Field::EntryAdded => alloc::format!("added, {after}"),
            Field::ObjectRemoved | Field::EntryRemoved => alloc::format!("removed, {before}"),
            field => alloc::format!("{} {before} -> {after}", field.name()),
        }
    }
}
