//! Checks values against their limits, both values of a master and saved values.

use od_model::Kind;
use od_model::real::Reals;
use od_model::row::Row;

use crate::store::Store;

/// Reason why an object cannot have a value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Outside {
    /// Above the upper limit.
    Above,
    /// Below the lower limit.
    Below,
    /// A BOOLEAN that is neither 0 nor 1, or a REAL that is not a number although it has limits.
    NotAllowed,
    /// A REAL with a length other than 4 or 8 bytes.
    Length,
}

/// Checks a value against the limits of an entry. `bytes` has the entry's length.
pub(crate) fn check(store: &Store<'_>, row: &Row, bytes: &[u8]) -> Result<(), Outside> {
    check_with(store, row, bytes, store.dictionary().reals())
}

/// As [`check`], for a device of which the compiler may know that it has no REALs.
pub(crate) fn check_with(
    store: &Store<'_>,
    row: &Row,
    bytes: &[u8],
    reals: Option<&'static Reals>,
) -> Result<(), Outside> {
    let kind = row.kind();
    if kind == Kind::Boolean && bytes.first().is_some_and(|byte| *byte > 1) {
        return Err(Outside::NotAllowed);
    }
    if reals.is_some() && kind == Kind::Real && !matches!(bytes.len(), 4 | 8) {
        return Err(Outside::Length);
    }
    if row.has_limits() {
        compare(store, row, bytes, kind, reals)
    } else {
        Ok(())
    }
}

/// Bits of an infinite REAL64. Those of what is not a number are above, without the sign.
const REAL64_INFINITE: u64 = 0x7FF << 52;

/// Compares a number with its limits.
#[inline]
fn compare(
    store: &Store<'_>,
    row: &Row,
    bytes: &[u8],
    kind: Kind,
    reals: Option<&'static Reals>,
) -> Result<(), Outside> {
    let reals = reals.filter(|_| kind == Kind::Real);
    let is_signed = kind == Kind::Signed;
    let is_negative = is_signed && bytes.last().is_some_and(|byte| byte & 0x80 != 0);
    let above = if is_negative { u64::MAX } else { 0 };
    let digits = bytes.iter().take(8).rev();
    let mut value = digits.fold(above, |number, byte| number << 8 | u64::from(*byte));
    if let Some(reals) = reals {
        if bytes.len() == 4 {
            value = (reals.widened)(value as u32);
        }
        // Not a number: no limit would stop it.
        if value << 1 > REAL64_INFINITE << 1 {
            return Err(Outside::NotAllowed);
        }
    }
    // The limits of an entry have its type, so both sides compare in the same order.
    let sign = if is_signed { 1 << 63 } else { 0 };
    let is_greater = |one: u64, other: u64| match reals {
        Some(reals) => (reals.is_greater)(one, other),
        None => one ^ sign > other ^ sign,
    };
    let pool = store.dictionary().pool();
    let limit = |is_upper| row.limit(is_upper, pool, store.node_id().raw());
    if limit(true).is_some_and(|high| is_greater(value, high)) {
        Err(Outside::Above)
    } else if limit(false).is_some_and(|low| is_greater(low, value)) {
        Err(Outside::Below)
    } else {
        Ok(())
    }
}
