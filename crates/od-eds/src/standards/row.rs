//! A row in the table of a device profile: an object and its facts.

use od_model::{DataType, ObjectCode};

/// One object of a device profile, or a range of objects of the same kind.
pub(super) struct Row {
    pub(super) first: u16,
    pub(super) last: u16,
    pub(super) name: &'static str,
    pub(super) checked: Option<Checked>,
    /// Types that no rule checks: first and last sub-index, type.
    pub(super) types: &'static [(u8, u8, DataType)],
}

/// Facts that the rules check about an object.
pub(crate) struct Checked {
    /// VAR or ARRAY; an ARRAY may be a RECORD as well.
    pub(crate) code: ObjectCode,
    /// The types that the value, or every sub-object, may have; empty if each sub-object has a type of its own.
    pub(crate) data_types: &'static [DataType],
    /// First and last sub-index, and their type.
    pub(crate) members: &'static [(u8, u8, DataType)],
    /// Whether a master may write it; `None`: the profile does not say.
    pub(crate) writable: Option<bool>,
}

/// An object with facts that no rule checks.
pub(super) const fn named(first: u16, last: u16, name: &'static str) -> Row {
    Row {
        first,
        last,
        name,
        checked: None,
        types: &[],
    }
}

impl Checked {
    /// The types that a value may have: of a VAR, or of a sub-object except the count.
    pub(crate) fn types(&self, sub: u8) -> impl Iterator<Item = DataType> {
        let own = self.members.iter();
        let own = own.filter(move |(first, last, _)| (*first..=*last).contains(&sub));
        let own = own.map(|(_, _, data_type)| *data_type);
        self.data_types.iter().copied().chain(own)
    }
}

impl Row {
    pub(super) const fn checked(
        self,
        code: ObjectCode,
        data_types: &'static [DataType],
        writable: Option<bool>,
    ) -> Self {
        let checked = Some(Checked {
            code,
            data_types,
            members: &[],
            writable,
        });
        Self { checked, ..self }
    }

    /// Types that no rule checks: first and last sub-index, type.
    pub(super) const fn with(self, types: &'static [(u8, u8, DataType)]) -> Self {
        Self { types, ..self }
    }
}

/// A RECORD with these sub-objects: first and last sub-index, type.
pub(super) const fn record(
    index: u16,
    members: &'static [(u8, u8, DataType)],
    name: &'static str,
) -> Row {
    let row = named(index, index, name);
    let checked = Some(Checked {
        code: ObjectCode::Record,
        data_types: &[],
        members,
        writable: None,
    });
    Row {
        checked,
        types: members,
        ..row
    }
}

/// A read-only VAR.
pub(super) const fn ro(index: u16, data_types: &'static [DataType], name: &'static str) -> Row {
    named(index, index, name).checked(ObjectCode::Var, data_types, Some(false))
}

/// A VAR that a master can write.
pub(super) const fn rw(index: u16, data_types: &'static [DataType], name: &'static str) -> Row {
    named(index, index, name).checked(ObjectCode::Var, data_types, Some(true))
}

/// A VAR that a master can write, or that is fixed in a simple device.
pub(super) const fn var(index: u16, data_types: &'static [DataType], name: &'static str) -> Row {
    named(index, index, name).checked(ObjectCode::Var, data_types, None)
}

/// Read-only sub-objects of one type.
pub(super) const fn ro_array(
    first: u16,
    last: u16,
    data_types: &'static [DataType],
    name: &'static str,
) -> Row {
    named(first, last, name).checked(ObjectCode::Array, data_types, Some(false))
}

/// Sub-objects of one type that a master can write.
pub(super) const fn rw_array(
    first: u16,
    last: u16,
    data_types: &'static [DataType],
    name: &'static str,
) -> Row {
    named(first, last, name).checked(ObjectCode::Array, data_types, Some(true))
}

/// Sub-objects of one type that a master can write, or that are fixed in a simple device.
pub(super) const fn array(
    first: u16,
    last: u16,
    data_types: &'static [DataType],
    name: &'static str,
) -> Row {
    named(first, last, name).checked(ObjectCode::Array, data_types, None)
}
