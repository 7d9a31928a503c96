//! Values against their limits: for what a master writes, and for what storage holds.

use od_model::Kind;
use od_model::row::Row;

use crate::number::number_in;
use crate::store::Store;

/// Reason why an object cannot have a value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Outside {
    /// Above the upper limit.
    Above,
    /// Below the lower limit.
    Below,
    /// A BOOLEAN that is neither 0 nor 1.
    NotAllowed,
    /// A REAL of a length that no REAL has.
    Length,
}

/// Checks a value against the limits of an entry. `bytes` has the entry's length.
#[inline(never)]
pub(crate) fn check(store: &Store<'_>, row: &Row, bytes: &[u8]) -> Result<(), Outside> {
    let kind = row.data_type().kind();
    if kind == Kind::Boolean && bytes.first().is_some_and(|byte| *byte > 1) {
        return Err(Outside::NotAllowed);
    }
    let dictionary = store.dictionary();
    let reals = match kind {
        Kind::Text | Kind::Bytes | Kind::Record => return Ok(()),
        Kind::Real if !matches!(bytes.len(), 4 | 8) => return Err(Outside::Length),
        Kind::Real => dictionary.reals(),
        _ => None,
    };
    let value = number_in(bytes);
    let unused = 64u32.saturating_sub(8 * bytes.len() as u32) & 63;
    let value = match reals {
        Some(reals) if bytes.len() == 4 => (reals.widened)(value as u32),
        _ if kind == Kind::Signed => ((value << unused) as i64 >> unused) as u64,
        _ => value,
    };
    // The limits of an entry are of its type, so both sides of a comparison have the same order.
    let sign = if kind == Kind::Signed { 1 << 63 } else { 0 };
    let is_greater = |one: u64, other: u64| match reals {
        Some(reals) => (reals.is_greater)(one, other),
        None => one ^ sign > other ^ sign,
    };
    let (pool, node_id) = (dictionary.pool(), store.node_id().raw());
    if let Some(high) = row.high(pool, node_id)
        && is_greater(value, high)
    {
        Err(Outside::Above)
    } else if let Some(low) = row.low(pool, node_id)
        && is_greater(low, value)
    {
        Err(Outside::Below)
    } else {
        Ok(())
    }
}
