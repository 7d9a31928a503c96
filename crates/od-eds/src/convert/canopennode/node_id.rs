//! Values that depend on the node ID: CANopenNode adds it only to a few COB-IDs.

use crate::description::{EntryDescription, Value};
use crate::subject::start_value;
use od_model::Address;

/// The CAN-ID at this address to which CANopenNode adds the node ID: that of
/// the pre-defined connection set (CiA 301, chapter 7.3.3).
pub(super) fn predefined(address: Address) -> Option<u32> {
    let Address { index, sub } = address;
    Some(match (index, sub) {
        (0x1014, 0) => 0x80,
        (0x1200, 1) => 0x600,
        (0x1200, 2) => 0x580,
        (0x1400..=0x1403, 1) => 0x200 + 0x100 * u32::from(index - 0x1400),
        (0x1800..=0x1803, 1) => 0x180 + 0x100 * u32::from(index - 0x1800),
        _ => return None,
    })
}

/// Returns whether CANopenNode adds the node ID to this number.
pub(super) fn is_added(address: Address, number: i128) -> bool {
    predefined(address).is_some_and(|base| number & 0x7FF == base.into())
}

/// The number of a value for the file: without the node ID if CANopenNode adds it, otherwise
/// with the given one, if there is one.
pub(super) fn number(address: Address, entry: &EntryDescription, node: Option<u8>) -> Option<i128> {
    let value = start_value(entry)?;
    let data_type = entry.data_type?.value;
    if !value.fits(data_type) {
        // An invalid ParameterValue leaves the default.
        let default = entry
            .default
            .as_ref()
            .filter(|value| value.fits(data_type))?;
        return of(address, default, node);
    }
    of(address, value, node)
}

fn of(address: Address, value: &Value, node: Option<u8>) -> Option<i128> {
    match *value {
        Value::NodeId(offset) if is_added(address, offset.into()) => Some(offset.into()),
        ref value => value.integer(node.unwrap_or(0)),
    }
}
