//! COB-IDs that are kept as the difference to their default, so that they move with the node ID.

use od_model::{Entry, Literal};

use crate::profile::SavedCobIds;
use crate::store::{Store, little_endian};
use od_wire::CobId;

/// Returns the bytes that are saved instead of the value; `None`: the value is saved.
pub(super) fn difference(store: &Store<'_>, entry: &Entry, rule: SavedCobIds) -> Option<[u8; 8]> {
    let default = default(store, entry, rule)?;
    Some(store.number(entry).wrapping_sub(default).to_le_bytes())
}

/// Makes the value of a saved difference, in place. Answers whether it is one that a COB-ID
/// can have: with another node ID it may have left the 11 bits.
pub(super) fn restore(
    store: &Store<'_>,
    entry: &Entry,
    rule: SavedCobIds,
    bytes: &mut [u8],
) -> bool {
    let Some(default) = default(store, entry, rule) else {
        return true;
    };
    let value = little_endian(bytes).wrapping_add(default);
    for (to, from) in bytes.iter_mut().zip(value.to_le_bytes()) {
        *to = from;
    }
    entry.address.index >= 0x2000 || CobId::new(value as u32).is_consistent()
}

/// The default that counts, if the value is kept as a difference.
fn default(store: &Store<'_>, entry: &Entry, rule: SavedCobIds) -> Option<u64> {
    let is_number = entry.data_type.size().is_some_and(|size| size <= 8);
    let follows = is_number && matches!(entry.default, Literal::NodeId(_));
    let default = entry.default.bits(store.node_id().raw())?;
    (follows && rule == SavedCobIds::Difference).then_some(default)
}
