//! COB-IDs that are kept as the difference to their default, so that they move with the node ID.

use od_model::row::Row;

use crate::number::{copy, number_in};
use crate::profile::SavedCobIds;
use crate::store::Store;
use od_wire::CobId;

/// Number that is subtracted from a saved value; 0: it is saved as it is.
pub(super) fn base(store: &Store<'_>, row: &Row, rule: SavedCobIds) -> u64 {
    if is_difference(row, rule) {
        default(store, row)
    } else {
        0
    }
}

/// Makes the value of a saved difference, in place. Answers whether it is one that a COB-ID
/// can have: with another node ID it may have left the 11 bits.
pub(super) fn restore(store: &Store<'_>, row: &Row, rule: SavedCobIds, bytes: &mut [u8]) -> bool {
    if !is_difference(row, rule) {
        return true;
    }
    let value = number_in(bytes).wrapping_add(default(store, row));
    copy(bytes, &value.to_le_bytes());
    row.index() >= 0x2000 || CobId::new(value as u32).is_consistent()
}

/// Returns whether the value is kept as the difference to its default.
fn is_difference(row: &Row, rule: SavedCobIds) -> bool {
    rule == SavedCobIds::Difference && !row.is_variable() && row.follows_node_id()
}

fn default(store: &Store<'_>, row: &Row) -> u64 {
    row.default(store.dictionary().pool(), store.node_id().raw())
}
