//! Limits of a number, by probing; the value is put back.

use od_model::DataType;

use super::probe::{Found, Probe};
use crate::fault::Fault;
use crate::link::Link;

/// The lowest and highest number that the node accepts; `None` where the type itself is the limit.
/// The numbers between the value and a limit are taken to be accepted.
pub(super) fn limits<L: Link>(
    probe: &mut Probe<L>,
    found: &Found,
    data_type: DataType,
) -> Result<[Option<u64>; 2], Fault> {
    let none = [None, None];
    let (Some(bytes), Some(size)) = (&found.bytes, data_type.size()) else {
        return Ok(none);
    };
    let Some((0, most)) = data_type.integer_range() else {
        return Ok(none);
    };
    let mut wide = [0; 8];
    wide[..size].copy_from_slice(&bytes[..size]);
    let value = u64::from_le_bytes(wide);
    let most = u64::try_from(most).unwrap_or(u64::MAX);
    let mut try_it = |number: u64| probe.write(found.address, &number.to_le_bytes()[..size]);
    let (mut low, mut high) = (None, None);
    if value < most && !try_it(most)? {
        let (mut good, mut bad) = (value, most);
        while bad - good > 1 {
            let middle = good + (bad - good) / 2;
            match try_it(middle)? {
                true => good = middle,
                false => bad = middle,
            }
        }
        high = Some(good);
    }
    if value > 0 && !try_it(0)? {
        let (mut good, mut bad) = (value, 0);
        while good - bad > 1 {
            let middle = bad + (good - bad) / 2;
            match try_it(middle)? {
                true => good = middle,
                false => bad = middle,
            }
        }
        low = Some(good);
    }
    try_it(value)?;
    Ok([low, high])
}
