//! Which values are saved, and which of them a sub-index of 1010h and 1011h covers.

use od_model::row::Row;
use od_model::{Address, Group};

use crate::profile::StoreProfile;

/// Returns whether the value is saved at all.
pub(super) const fn is_saved(row: &Row) -> bool {
    !matches!(row.group(), Group::None) && row.is_stored()
}

/// Returns whether the value belongs to the operating records (hours, counters of errors):
/// saved objects of the manufacturer that no master can write.
///
/// Every save includes them, and no restore takes them back.
pub const fn is_life_record(row: &Row) -> bool {
    matches!(row.group(), Group::Manufacturer) && !row.writable()
}

/// Returns whether the value is a saved setting, not one of the operating records.
pub(crate) const fn is_kept(row: &Row) -> bool {
    is_saved(row) && !is_life_record(row)
}

/// Returns whether sub-index `sub` of 1010h or 1011h covers this value, or the one that it is a
/// twin of.
pub(super) fn is_covered(profile: &StoreProfile, row: &Row, sub: u8) -> bool {
    let twin = |[one, other]: &[Address; 2]| match row.address() {
        address if address == *one => Some(*other),
        address if address == *other => Some(*one),
        _ => None,
    };
    let mut twins = profile.twins.iter().filter_map(twin);
    row.group().covered_by(sub)
        || is_saved(row) && twins.any(|twin| Group::of_index(twin.index).covered_by(sub))
}

/// Returns whether writing to sub-index `sub` of 1011h restores the default of this value.
pub fn restores(profile: &StoreProfile, row: &Row, sub: u8) -> bool {
    is_covered(profile, row, sub) && !is_life_record(row)
}
