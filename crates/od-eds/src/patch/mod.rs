//! Edits of a description: they build a spec table and define a variant.
//!
//! A patch is strict. It is an error to edit or remove an object that the base lacks, or
//! to add one that exists already; only a patch without such errors has no
//! findings. Every finding is a [`Finding`](crate::Finding) with the span
//! of its edit, so the caller can point at its own token:
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
    /// Adds an object or a member.
    Add,
    /// Changes fields of an existing one.
    Modify,
    /// Removes it; an object is removed with its members.
    Remove,
}

/// One field of an edit, with its new value.
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
    /// `None` removes the default.
    Default(Option<Raw>),
    /// `None` removes the limit.
    Low(Option<Raw>),
    /// `None` removes the limit.
    High(Option<Raw>),
}

impl Change {
    /// Its key in an EDS.
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
    /// The given fields, in their order; each span is that of the value.
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
    /// An edit without fields.
    pub fn new(action: Action, target: Target) -> Self {
        Self {
            action,
            target: Spanned::from(target),
            changes: Vec::new(),
        }
    }

    /// `add`, without fields.
    pub fn add(target: Target) -> Self {
        Self::new(Action::Add, target)
    }

    /// `modify`, without fields.
    pub fn modify(target: Target) -> Self {
        Self::new(Action::Modify, target)
    }

    /// `remove`.
    pub fn remove(target: Target) -> Self {
        Self::new(Action::Remove, target)
    }

    setters! {
        /// Sets the object code; the default is VAR.
        code(ObjectCode) => Change::Code;
        /// Sets the name.
        name(&str) => Change::Name;
        /// Sets the data type.
        data_type(DataType) => Change::Type;
        /// Sets the access; the default is `ro`.
        access(Access) => Change::Access;
        /// Sets whether a PDO can map it; the default is no.
        mappable(bool) => Change::Mappable;
        /// Sets the sub-index of 1010h that saves it.
        save(Group) => Change::Save;
        /// Sets the capacity of a string or DOMAIN in the store, in bytes.
        capacity(u16) => Change::Capacity;
        /// Sets the default.
        default(Raw) => |raw: Raw| Change::Default(Some(raw));
        /// Sets the smallest value.
        low(Raw) => |raw: Raw| Change::Low(Some(raw));
        /// Sets the largest value.
        high(Raw) => |raw: Raw| Change::High(Some(raw));
    }
}

#[cfg(test)]
mod tests;
