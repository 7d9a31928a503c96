//! One storage layout for a family of variants.
//!
//! A value has the same place in the store of every variant that has it with the
//! same type. A handle of the family therefore works with all of them, and a variant
//! re-exports it instead of making its own.

use std::collections::BTreeMap;

use od_eds::Tables;
use od_model::{Address, Slot};

/// Assigns a place to every stored value of the family; a string has room for its longest default.
pub(crate) fn lay_out(family: &mut [&mut Tables]) {
    let mut places: BTreeMap<(Address, u16), Slot> = BTreeMap::new();
    let stored = |tables: &Tables| {
        let stored = tables
            .dictionary()
            .entries()
            .filter(|entry| entry.slot.len > 0);
        stored
            .map(|entry| ((entry.address, entry.data_type.code()), entry.slot.len))
            .collect::<Vec<_>>()
    };
    for (key, len) in family.iter().flat_map(|tables| stored(tables)) {
        let place = places.entry(key).or_default();
        place.len = place.len.max(len);
    }
    let mut offset = 0;
    for place in places.values_mut() {
        place.offset = offset;
        offset += u32::from(place.len);
    }
    for tables in family {
        tables.place(|entry| {
            let place = places.get(&(entry.address, entry.data_type.code()));
            place.copied().unwrap_or(entry.slot)
        });
    }
}
