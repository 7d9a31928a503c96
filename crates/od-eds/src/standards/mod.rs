//! Facts about objects from the CiA documents, with a file for each document. Rules, names in an
//! editor, and the types of a node without an EDS use them. `cia301` has the objects of CiA 302,
//! too.

pub(crate) mod cia301;
mod cia401;
mod cia402;
mod cia404;
mod cia406;
#[cfg(test)]
mod documents;
mod meanings;
mod row;

use alloc::vec::Vec;

use od_model::DataType;

use crate::standards::row::Row;

pub use crate::standards::meanings::{meaning, meaning_of_bytes, meanings};
pub(crate) use crate::standards::row::Checked;

/// The tables of a profile; none if odkit does not know it.
const fn tables(profile: u16) -> &'static [&'static [Row]] {
    match profile {
        401 => &[cia401::TABLE],
        402 => &[cia402::TABLE],
        404 => cia404::TABLES,
        406 => &[cia406::TABLE],
        _ => &[],
    }
}

fn rows(profile: u16) -> impl Iterator<Item = &'static Row> {
    tables(profile).iter().copied().flatten()
}

/// The index that an object of CiA 401 and 402 has in the first logical device or axis: those of the others are 800h apart.
const fn in_first(profile: u16, index: u16) -> u16 {
    match profile {
        401 | 402 if index >= 0x6000 && index < 0xA000 => 0x6000 + (index - 0x6000) % 0x800,
        _ => index,
    }
}

fn row(profile: u16, index: u16) -> Option<&'static Row> {
    let index = in_first(profile, index);
    rows(profile).find(|row| (row.first..=row.last).contains(&index))
}

/// Facts that the rules check about an object of a profile.
pub(crate) fn checked(profile: u16, index: u16) -> Option<&'static Checked> {
    row(profile, index)?.checked.as_ref()
}

/// The name of an object in a device profile; `None` if the profile does not have it.
pub fn profile_name(profile: u16, index: u16) -> Option<&'static str> {
    row(profile, index).map(|row| row.name)
}

/// The objects of a device profile: first index and name.
pub fn profile_objects(profile: u16) -> impl Iterator<Item = (u16, &'static str)> {
    rows(profile).map(|row| (row.first, row.name))
}

/// The types of a value in a device profile.
pub fn profile_types(profile: u16, index: u16, sub: u8) -> Vec<DataType> {
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
            for rows in tables(profile) {
                assert!(rows.iter().all(|row| row.first <= row.last));
                for two in rows.windows(2) {
                    let [row, next] = [two[0].last, two[1].first];
                    assert!(
                        row < next,
                        "CiA {profile}: move the row of {next:04X}h before that of {row:04X}h"
                    );
                }
            }
        }
    }

    #[test]
    fn an_object_has_name_and_types() {
        assert_eq!(profile_name(406, 0x6004), Some("Position value"));
        assert_eq!(profile_name(406, 0x7000), None);
        assert_eq!(profile_types(406, 0x6004, 0), [DataType::Unsigned32]);
        assert_eq!(profile_types(402, 0x6049, 2), [DataType::Unsigned16]);
        // The fourth axis.
        assert_eq!(profile_types(402, 0x7862, 0), [DataType::Integer32]);
        assert_eq!(profile_types(404, 0x7130, 1), [DataType::Integer16]);
        assert_eq!(profile_types(404, 0x6110, 1), [DataType::Unsigned16]);
        assert!(checked(404, 0x6111).is_none() && checked(402, 0x604D).is_none());
    }
}
