//! What the documents of CiA say of objects, a file for each document: its rules, names in an editor, and
//! types of a node without an EDS are read here. `cia301` has the objects of CiA 302, too.

pub(crate) mod cia301;
mod cia401;
mod cia402;
mod cia404;
mod cia406;

use alloc::vec::Vec;

use od_model::{DataType, ObjectCode};

/// One object of a device profile, or a range of objects that are alike.
pub(crate) struct Row {
    first: u16,
    last: u16,
    name: &'static str,
    checked: Option<Checked>,
    /// Types that no rule checks: first and last sub-index, type.
    types: &'static [(u8, u8, DataType)],
}

/// What the rules check of an object.
pub(crate) struct Checked {
    /// VAR or ARRAY; an ARRAY may be a RECORD as well.
    pub(crate) code: ObjectCode,
    /// The types that the value, or every sub-object, may have.
    pub(crate) data_types: &'static [DataType],
    /// May a master write it? `None` where the profile leaves it open.
    pub(crate) writable: Option<bool>,
}

/// An object of which no rule checks anything.
const fn named(first: u16, last: u16, name: &'static str) -> Row {
    Row {
        first,
        last,
        name,
        checked: None,
        types: &[],
    }
}

impl Row {
    const fn checked(
        self,
        code: ObjectCode,
        data_types: &'static [DataType],
        writable: Option<bool>,
    ) -> Self {
        let checked = Some(Checked {
            code,
            data_types,
            writable,
        });
        Self { checked, ..self }
    }

    /// Types that no rule checks: first and last sub-index, type.
    const fn with(self, types: &'static [(u8, u8, DataType)]) -> Self {
        Self { types, ..self }
    }
}

/// A VAR that is read only.
const fn ro(index: u16, data_types: &'static [DataType], name: &'static str) -> Row {
    named(index, index, name).checked(ObjectCode::Var, data_types, Some(false))
}

/// A VAR that a master writes.
const fn rw(index: u16, data_types: &'static [DataType], name: &'static str) -> Row {
    named(index, index, name).checked(ObjectCode::Var, data_types, Some(true))
}

/// A VAR that a master writes, or that is fixed in a simple device.
const fn var(index: u16, data_types: &'static [DataType], name: &'static str) -> Row {
    named(index, index, name).checked(ObjectCode::Var, data_types, None)
}

/// Sub-objects of one type that are read only.
const fn ro_array(
    first: u16,
    last: u16,
    data_types: &'static [DataType],
    name: &'static str,
) -> Row {
    named(first, last, name).checked(ObjectCode::Array, data_types, Some(false))
}

/// Sub-objects of one type that a master writes.
const fn rw_array(
    first: u16,
    last: u16,
    data_types: &'static [DataType],
    name: &'static str,
) -> Row {
    named(first, last, name).checked(ObjectCode::Array, data_types, Some(true))
}

/// Sub-objects of one type that a master writes, or that are fixed in a simple device.
const fn array(first: u16, last: u16, data_types: &'static [DataType], name: &'static str) -> Row {
    named(first, last, name).checked(ObjectCode::Array, data_types, None)
}

/// The rows of a profile; none if odkit does not know it.
const fn table(profile: u16) -> &'static [Row] {
    match profile {
        401 => cia401::TABLE,
        402 => cia402::TABLE,
        404 => cia404::TABLE,
        406 => cia406::TABLE,
        _ => &[],
    }
}

fn row(profile: u16, index: u16) -> Option<&'static Row> {
    let mut rows = table(profile).iter();
    rows.find(|row| (row.first..=row.last).contains(&index))
}

/// What the rules check of an object of a profile.
pub(crate) fn checked(profile: u16, index: u16) -> Option<&'static Checked> {
    row(profile, index)?.checked.as_ref()
}

/// The name of an object in a device profile; `None` if the profile does not have it.
pub fn profile_name(profile: u16, index: u16) -> Option<&'static str> {
    row(profile, index).map(|row| row.name)
}

/// The objects of a device profile: first index and name.
pub fn profile_objects(profile: u16) -> impl Iterator<Item = (u16, &'static str)> {
    table(profile).iter().map(|row| (row.first, row.name))
}

/// The types that a device profile gives a value.
pub fn profile_types(profile: u16, index: u16, sub: u8) -> Vec<DataType> {
    if profile == 404 {
        return cia404::value_type(index).into_iter().collect();
    }
    let Some(row) = row(profile, index) else {
        return Vec::new();
    };
    let own = row.types.iter();
    let own = own.filter(|(first, last, _)| (*first..=*last).contains(&sub));
    let own = own.map(|(_, _, data_type)| *data_type);
    let checked = row.checked.iter().flat_map(|checked| checked.data_types);
    own.chain(checked.copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_sorted() {
        for profile in [401, 402, 404, 406] {
            let rows = table(profile);
            assert!(rows.iter().all(|row| row.first <= row.last));
            assert!(rows.windows(2).all(|two| two[0].last < two[1].first));
        }
    }

    #[test]
    fn an_object_has_name_and_types() {
        assert_eq!(profile_name(406, 0x6004), Some("Position value"));
        assert_eq!(profile_name(406, 0x7000), None);
        assert_eq!(profile_types(406, 0x6004, 0), [DataType::Unsigned32]);
        assert_eq!(profile_types(402, 0x6049, 2), [DataType::Unsigned16]);
        assert_eq!(profile_types(404, 0x7130, 1), [DataType::Integer16]);
        assert!(checked(404, 0x6130).is_none() && checked(402, 0x6049).is_none());
    }
}
