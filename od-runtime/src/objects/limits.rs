//! Values against their limits.

use od_model::{Entry, Kind, Literal};

use crate::{AbortCode, Profile, Store};

/// Does the value lie in the entry's limits? `bytes` has the entry's length.
pub(super) fn check(
    store: &Store<'_>,
    profile: &Profile,
    entry: &Entry,
    bytes: &[u8],
) -> Result<(), AbortCode> {
    let node_id = store.node_id().raw();
    match entry.data_type.kind() {
        Kind::Boolean if bytes.first().is_some_and(|byte| *byte > 1) => {
            return Err(AbortCode::ValueRange);
        }
        Kind::Boolean | Kind::Unsigned | Kind::Signed => {
            let value = integer(entry, bytes);
            if entry.high.integer(node_id).is_some_and(|high| value > high) {
                return Err(AbortCode::ValueTooHigh);
            }
            if entry.low.integer(node_id).is_some_and(|low| value < low) {
                return Err(profile.sdo.below_limit);
            }
        }
        Kind::Real => {
            let value = match *bytes {
                [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
                [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
                _ => return Err(AbortCode::Length),
            };
            if matches!(entry.high, Literal::Real(high) if value > high) {
                return Err(AbortCode::ValueTooHigh);
            }
            if matches!(entry.low, Literal::Real(low) if value < low) {
                return Err(profile.sdo.below_limit);
            }
        }
        Kind::Text | Kind::Bytes | Kind::Record => {}
    }
    Ok(())
}

fn integer(entry: &Entry, bytes: &[u8]) -> i128 {
    use od_model::typed::Scalar;
    match entry.data_type.kind() {
        Kind::Signed => i64::from_wire(bytes).into(),
        _ => u64::from_wire(bytes).into(),
    }
}
