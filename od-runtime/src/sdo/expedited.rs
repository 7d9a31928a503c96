//! Expedited download (CiA 301, chapter 7.2.4.3.3): the value is in the request.

use od_model::row::Row;
use od_wire::AbortCode;

use crate::profile::SdoProfile;

/// Returns how many of the up to four bytes that came with the request are the value. Where no
/// size was indicated, the object's own counts; where the frame is shorter than its data, what is
/// missing was not given.
pub(super) fn len(
    profile: &SdoProfile,
    row: &Row,
    size: Option<u32>,
    dlc: u8,
) -> Result<usize, AbortCode> {
    let given = usize::from(dlc.saturating_sub(4)).min(4);
    let own = Some(row.size()).filter(|size| *size > 0);
    let len = match size {
        // Bytes that do not count need not be there either.
        Some(size) if profile.length.too_long.is_none() => {
            (size as usize).min(own.unwrap_or(4)).min(4)
        }
        Some(size) => (size as usize).min(4),
        None => own.unwrap_or(given),
    };
    if len > given {
        return Err(profile.length.too_short);
    }
    Ok(len)
}
