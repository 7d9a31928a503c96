//! Values against their limits: for what a master writes, and for what storage holds.

use od_model::typed::Scalar;
use od_model::{Entry, Kind, Literal};

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
pub(crate) fn check(store: &Store<'_>, entry: &Entry, bytes: &[u8]) -> Result<(), Outside> {
    match entry.data_type.kind() {
        Kind::Boolean if bytes.first().is_some_and(|byte| *byte > 1) => Err(Outside::NotAllowed),
        Kind::Signed => integer(store, entry, i64::from_wire(bytes) as u64 ^ SIGN, SIGN),
        Kind::Boolean | Kind::Unsigned => integer(store, entry, u64::from_wire(bytes), 0),
        Kind::Real => real(entry, bytes),
        Kind::Text | Kind::Bytes | Kind::Record => Ok(()),
    }
}

/// Bit that differs between the order of signed and of unsigned numbers.
const SIGN: u64 = 1 << 63;

/// The limits of an entry are of its type, so both sides of a comparison have the same order.
fn integer(store: &Store<'_>, entry: &Entry, value: u64, sign: u64) -> Result<(), Outside> {
    let node_id = store.node_id().raw();
    if entry
        .high
        .bits(node_id)
        .is_some_and(|high| value > high ^ sign)
    {
        Err(Outside::Above)
    } else if entry
        .low
        .bits(node_id)
        .is_some_and(|low| value < low ^ sign)
    {
        Err(Outside::Below)
    } else {
        Ok(())
    }
}

fn real(entry: &Entry, bytes: &[u8]) -> Result<(), Outside> {
    let value = match *bytes {
        [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
        [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        _ => return Err(Outside::Length),
    };
    if matches!(entry.high, Literal::Real(high) if value > high) {
        Err(Outside::Above)
    } else if matches!(entry.low, Literal::Real(low) if value < low) {
        Err(Outside::Below)
    } else {
        Ok(())
    }
}
