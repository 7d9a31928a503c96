//! Subject of a check: one value or one object, with the description it belongs to.

use core::ops::Deref;

use od_model::{Address, ObjectCode};

use crate::description::{Description, EntryDescription, ObjectDescription, Value};
use crate::fact::{Fact, Key};
use crate::span::{Span, Spanned};

/// Something in a description that a finding can be about.
pub(crate) trait Subject {
    /// The address that the finding gets.
    fn address(&self) -> Address;
    /// Place of the finding if its own place is in no text.
    fn span(&self) -> Span;
}

/// One value of an object.
pub(crate) struct Entry<'a> {
    pub(crate) description: &'a Description,
    pub(crate) object: &'a ObjectDescription,
    pub(crate) address: Address,
    pub(crate) entry: &'a EntryDescription,
}

impl Deref for Entry<'_> {
    type Target = EntryDescription;
    fn deref(&self) -> &EntryDescription {
        self.entry
    }
}

impl Subject for Entry<'_> {
    fn address(&self) -> Address {
        self.address
    }
    fn span(&self) -> Span {
        self.entry.span
    }
}

impl Entry<'_> {
    /// Returns whether the file has a text under this key that odkit could not read as a value.
    pub(crate) fn is_unread(&self, key: Key) -> bool {
        self.extra.iter().any(|(name, _)| key.is(name))
    }

    /// The place that makes it exist: its section, or the number in CompactSubObj.
    pub(crate) fn origin(&self) -> Span {
        let is_copy = self.address.sub > 0 && self.entry.span == self.object.span;
        let count = self.object.entries.get(&0).filter(|_| is_copy);
        count.map_or(self.entry.span, |count| count.span)
    }

    /// Its address in a sentence.
    pub(crate) fn shown(&self) -> Fact {
        shown(self.object, self.address)
    }
}

pub(crate) struct Object<'a> {
    pub(crate) description: &'a Description,
    pub(crate) index: u16,
    pub(crate) object: &'a ObjectDescription,
}

impl Deref for Object<'_> {
    type Target = ObjectDescription;
    fn deref(&self) -> &ObjectDescription {
        self.object
    }
}

impl Subject for Object<'_> {
    fn address(&self) -> Address {
        Address::new(self.index, 0)
    }
    fn span(&self) -> Span {
        self.object.span
    }
}

impl<'a> Object<'a> {
    /// The object at an index.
    pub(crate) fn of(description: &'a Description, index: u16) -> Option<Self> {
        let object = description.objects.get(&index)?;
        Some(Self {
            description,
            index,
            object,
        })
    }

    /// Each of its values.
    pub(crate) fn entries(&self) -> impl Iterator<Item = Entry<'a>> + use<'a> {
        let (description, index, object) = (self.description, self.index, self.object);
        object.entries.iter().map(move |(sub, entry)| Entry {
            description,
            object,
            address: Address::new(index, *sub),
            entry,
        })
    }
}

/// All objects, in order.
pub(crate) fn objects(description: &Description) -> impl Iterator<Item = Object<'_>> {
    let objects = description.objects.iter();
    objects.map(|(index, object)| Object {
        description,
        index: *index,
        object,
    })
}

/// Returns whether it describes a type, and has no value.
pub(crate) fn is_definition(object: &ObjectDescription) -> bool {
    matches!(
        *object.code,
        ObjectCode::Null | ObjectCode::DefType | ObjectCode::DefStruct
    )
}

/// An address in a sentence: without sub-index if the object has only one value.
pub(crate) fn shown(object: &ObjectDescription, address: Address) -> Fact {
    if !object.code.has_members() && address.sub == 0 {
        Fact::Index(address.index)
    } else {
        Fact::Object(address)
    }
}

/// The start value of an entry: the ParameterValue of a DCF, otherwise the default.
pub(crate) fn start_value(entry: &EntryDescription) -> Option<&Spanned<Value>> {
    entry.parameter.as_ref().or(entry.default.as_ref())
}

/// The start value of an entry as an unsigned number.
pub(crate) fn start_number(description: &Description, address: Address) -> Option<Spanned<u64>> {
    let value = start_value(description.entry(address)?)?;
    match value.value.integer(0) {
        Some(number) if !matches!(value.value, Value::NodeId(_)) => {
            let number = u64::try_from(number).ok()?;
            Some(Spanned::new(number, value.span))
        }
        _ => None,
    }
}
