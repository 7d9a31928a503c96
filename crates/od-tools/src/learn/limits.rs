//! Probes the limits of a number, and restores the value.

use od_model::DataType;

use super::probe::{FoundObject, Probe};
use super::types::with_sign;
use crate::error::Error;
use crate::link::Link;

/// Properties of a number that were found by writing.
pub(super) struct Learned {
    /// The type; signed if a limit is negative.
    pub(super) data_type: DataType,
    /// The value, in this type.
    pub(super) value: Option<i128>,
    /// The lowest and the highest number that the node accepts; `None` if it is that of the type. Numbers between
    /// the value and a limit are assumed to be accepted.
    pub(super) low: Option<i128>,
    pub(super) high: Option<i128>,
}

/// Probes the limits. A type that only the length suggests becomes signed if the node accepts -1 but not the
/// lowest number of the signed type.
pub(super) fn limits<L: Link>(
    probe: &mut Probe<L>,
    found: &FoundObject,
    data_type: DataType,
    is_sure: bool,
) -> Result<Learned, Error> {
    let mut learned = Learned {
        data_type,
        value: None,
        low: None,
        high: None,
    };
    let (Some(bytes), Some(size)) = (&found.bytes, data_type.size()) else {
        return Ok(learned);
    };
    if data_type.integer_range().is_none() || bytes.len() != size || size > 8 {
        return Ok(learned);
    }
    let result = probed(probe, found, bytes, is_sure, &mut learned);
    if matches!(result, Err(Error::Interrupted)) {
        probe.resume();
    }
    probe.put_back(found.address, bytes)?;
    result.map(|()| learned)
}

fn probed<L: Link>(
    probe: &mut Probe<L>,
    found: &FoundObject,
    bytes: &[u8],
    is_sure: bool,
    learned: &mut Learned,
) -> Result<(), Error> {
    let size = bytes.len();
    let mut accepts = |number: i128| probe.write(found.address, &number.to_le_bytes()[..size]);
    if let Some(signed) = with_sign(learned.data_type).filter(|_| !is_sure)
        && let Some((lowest, _)) = signed.integer_range()
        && accepts(-1)?
        && !accepts(lowest)?
    {
        learned.data_type = signed;
    }
    let Some((lowest, highest)) = learned.data_type.integer_range() else {
        return Ok(());
    };
    let mut wide = [0; 16];
    wide[..size].copy_from_slice(bytes);
    let mut value = i128::from_le_bytes(wide);
    if value > highest {
        value -= 1 << (8 * size);
    }
    learned.value = Some(value);
    if value < highest && !accepts(highest)? {
        learned.high = Some(edge(value, highest, &mut accepts)?);
    }
    if value > lowest && !accepts(lowest)? {
        learned.low = Some(edge(value, lowest, &mut accepts)?);
    }
    Ok(())
}

/// The last accepted number between an accepted and a refused one, by bisection.
fn edge(
    mut good: i128,
    mut bad: i128,
    accepts: &mut impl FnMut(i128) -> Result<bool, Error>,
) -> Result<i128, Error> {
    while good.abs_diff(bad) > 1 {
        let middle = (good + bad).div_euclid(2);
        if accepts(middle)? {
            good = middle
        } else {
            bad = middle
        }
    }
    Ok(good)
}
