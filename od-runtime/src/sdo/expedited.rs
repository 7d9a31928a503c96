//! Expedited download (CiA 301, chapter 7.2.4.3.3): the value is in the request.

use od_model::Address;

use crate::device::Device;
use crate::objects::Objects;
use od_wire::AbortCode;

/// Writes the up to four bytes that came with the request. Where no size was indicated,
/// the object's own counts; where the frame is shorter than its data, what is missing was
/// not given.
pub(super) fn download<D: Device>(
    objects: &mut Objects<'_, D>,
    address: Address,
    size: Option<u32>,
    bytes: &[u8; 4],
    dlc: u8,
) -> Result<(), AbortCode> {
    let entry = objects.writable(address, None)?;
    let given = usize::from(dlc.saturating_sub(4)).min(4);
    let own = entry.data_type.size();
    let len = match size {
        // Bytes that do not count need not be there either.
        Some(size) if objects.profile().sdo.length.too_long.is_none() => {
            (size as usize).min(own.unwrap_or(4)).min(4)
        }
        Some(size) => (size as usize).min(4),
        None => own.unwrap_or(given),
    };
    if len > given {
        return Err(objects.profile().sdo.length.too_short);
    }
    objects.write(address, &bytes[..len])
}
