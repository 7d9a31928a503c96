//! COB-IDs that are saved as the difference to their default, so that they follow the node ID.

use od_model::row::Row;

use crate::number::{copy, number_in};
use crate::profile::SavedCobIds;
use crate::store::Store;
use od_wire::CobId;

/// Returns the number that is subtracted from a saved value; 0: the value is saved unchanged.
pub(super) fn base(store: &Store<'_>, row: &Row, rule: SavedCobIds) -> u64 {
    if is_difference(row, rule) {
        default(store, row)
    } else {
        0
    }
}

/// Converts a saved difference to its value, in place. Returns whether a COB-ID can have this
/// value: with another node ID it may be outside the 11 bits.
pub(super) fn restore(store: &Store<'_>, row: &Row, rule: SavedCobIds, bytes: &mut [u8]) -> bool {
    if !is_difference(row, rule) {
        return true;
    }
    let value = number_in(bytes).wrapping_add(default(store, row));
    copy(bytes, &value.to_le_bytes());
    row.index() >= 0x2000 || CobId::new(value as u32).is_consistent()
}

/// Returns whether the value is saved as the difference to its default.
fn is_difference(row: &Row, rule: SavedCobIds) -> bool {
    rule == SavedCobIds::Difference && !row.is_variable() && row.follows_node_id()
}

fn default(store: &Store<'_>, row: &Row) -> u64 {
    row.default(store.dictionary().pool(), store.node_id().raw())
}
