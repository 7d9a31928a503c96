//! Edits to a description: how a spec table is built and how a variant differs.
//!
//! A patch is strict. Editing or removing what the base lacks is an error, and so
//! is adding what is there already; a patch that says nothing false is the only
//! one that applies without a word. Every finding is a [`Finding`](crate::Finding) whose span
//! is the one that the edit carries, so the caller can point at its own token:
//! see [`token`](crate::token).
//!
//! ```
//! use od_eds::patch::{self, Edit, Raw, Target};
//! use od_eds::Description;
//! use od_model::DataType;
//!
//! let mut device = Description::default();
//! let gear = Edit::add(Target::object(0x2110))
//!     .name("Gear")
//!     .data_type(DataType::Unsigned16)
//!     .default(Raw::Integer(4));
//! assert!(patch::apply(&mut device, &[gear.clone()]).is_empty());
//!
//! let findings = patch::apply(&mut device, &[gear]);
//! let told = od_eds::say(&findings[0], &od_eds::Eds);
//! assert_eq!(told.message, "2110h already exists");
//! ```

use alloc::string::String;
use alloc::vec::Vec;

use crate::fact::Key;
use crate::span::Spanned;
use od_model::{Access, DataType, Group, ObjectCode};

mod apply;
mod count;
mod find;
mod raw;
pub(crate) mod target;

pub use apply::apply;
pub use find::missing;
pub use raw::Raw;
pub use target::Target;

/// Action of an edit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Action {
    /// Makes an object or a member that is not there yet.
    Add,
    /// Changes some fields of one that is.
    Modify,
    /// Takes it away; an object goes with its members.
    Remove,
}

/// One field of an edit, and what it becomes.
#[derive(Clone, PartialEq, Debug)]
#[allow(missing_docs)] // the variants are the fields' names
pub enum Change {
    Code(ObjectCode),
    Name(String),
    Type(DataType),
    Access(Access),
    Mappable(bool),
    Save(Group),
    /// In bytes.
    Capacity(u16),
    /// `None` takes the default away.
    Default(Option<Raw>),
    /// `None` takes the limit away.
    Low(Option<Raw>),
    /// `None` takes the limit away.
    High(Option<Raw>),
}

impl Change {
    /// The key that it is in an EDS.
    pub const fn key(&self) -> Key {
        match self {
            Self::Code(_) => Key::ObjectType,
            Self::Name(_) => Key::ParameterName,
            Self::Type(_) => Key::DataType,
            Self::Access(_) => Key::AccessType,
            Self::Mappable(_) => Key::PdoMapping,
            Self::Save(_) => Key::StorageLocation,
            Self::Capacity(_) => Key::Capacity,
            Self::Default(_) => Key::DefaultValue,
            Self::Low(_) => Key::LowLimit,
            Self::High(_) => Key::HighLimit,
        }
    }
}

/// One statement of a patch.
#[derive(Clone, PartialEq, Debug)]
pub struct Edit {
    /// Add, modify or remove.
    pub action: Action,
    /// Object or sub-object.
    pub target: Spanned<Target>,
    /// The fields given, in the order they were given; the span is the value's.
    pub changes: Vec<Spanned<Change>>,
}

macro_rules! setters {
    ($($(#[$doc:meta])* $name:ident($t:ty) => $variant:expr;)*) => {$(
        $(#[$doc])*
        #[must_use]
        pub fn $name(mut self, value: $t) -> Self {
            self.changes.push(Spanned::from($variant(value.into())));
            self
        }
    )*};
}

impl Edit {
    /// An edit without fields yet.
    pub fn new(action: Action, target: Target) -> Self {
        Self {
            action,
            target: Spanned::from(target),
            changes: Vec::new(),
        }
    }

    /// `add`, without fields yet.
    pub fn add(target: Target) -> Self {
        Self::new(Action::Add, target)
    }

    /// `modify`, without fields yet.
    pub fn modify(target: Target) -> Self {
        Self::new(Action::Modify, target)
    }

    /// `remove`.
    pub fn remove(target: Target) -> Self {
        Self::new(Action::Remove, target)
    }

    setters! {
        /// Says the object code; VAR unless said.
        code(ObjectCode) => Change::Code;
        /// Says the name.
        name(&str) => Change::Name;
        /// Says the data type.
        data_type(DataType) => Change::Type;
        /// Says the access; `ro` unless said.
        access(Access) => Change::Access;
        /// Says whether a PDO can carry it; no unless said.
        mappable(bool) => Change::Mappable;
        /// Says which sub-index of 1010h saves it.
        save(Group) => Change::Save;
        /// Says how many bytes of a string or DOMAIN the store holds.
        capacity(u16) => Change::Capacity;
        /// Says the default.
        default(Raw) => |raw: Raw| Change::Default(Some(raw));
        /// Says the smallest value.
        low(Raw) => |raw: Raw| Change::Low(Some(raw));
        /// Says the largest value.
        high(Raw) => |raw: Raw| Change::High(Some(raw));
    }
}

#[cfg(test)]
mod tests;
