//! Differences that break a master configured for the first device.

use crate::diff::difference::Impact;
use od_model::{Access, Address, Dictionary, Entry, Group, Literal, ObjectCode};

const fn breaking(if_so: bool) -> Impact {
    if if_so {
        Impact::Breaking
    } else {
        Impact::Compatible
    }
}

/// ARRAY and RECORD are the same on the bus; a VAR differs from both.
pub(super) fn object_code(before: ObjectCode, after: ObjectCode) -> Impact {
    breaking(before.has_members() != after.has_members())
}

/// A master can no longer read or write a value.
pub(super) fn access(before: Access, after: Access) -> Impact {
    breaking(before.readable() && !after.readable() || before.writable() && !after.writable())
}

/// The value can no longer be mapped in one of its directions.
pub(super) fn mapping(before: &Entry, after: &Entry) -> Impact {
    breaking(
        before.maps_to_tpdo() && !after.maps_to_tpdo()
            || before.maps_to_rpdo() && !after.maps_to_rpdo(),
    )
}

/// A saved value is lost at power-off.
pub(super) fn storage(after: Group) -> Impact {
    breaking(after == Group::None)
}

/// The range of values from a master became narrower at its lower or upper end. A
/// missing limit is that of the type. For values that only the device sets, limits do not matter.
pub(super) fn limits(before: &Entry, after: &Entry) -> (Impact, Impact) {
    if !before.access.writable() || before.data_type != after.data_type {
        return (Impact::Compatible, Impact::Compatible);
    }
    let (low, high) = match (range(before), range(after)) {
        (Some((low, high)), Some((new_low, new_high))) => (new_low > low, new_high < high),
        _ => {
            let ((low, high), (new_low, new_high)) = (reals(before), reals(after));
            (new_low > low, new_high < high)
        }
    };
    (breaking(low), breaking(high))
}

/// Smallest and largest value of an integer entry; for node ID 1.
fn range(entry: &Entry) -> Option<(i128, i128)> {
    let (low, high) = entry.data_type.integer_range()?;
    Some((
        entry.low.integer(1).unwrap_or(low),
        entry.high.integer(1).unwrap_or(high),
    ))
}

/// Smallest and largest value of a REAL.
fn reals(entry: &Entry) -> (f64, f64) {
    let number = |literal, or| match literal {
        Literal::Real(value) => value,
        _ => or,
    };
    (
        number(entry.low, f64::NEG_INFINITY),
        number(entry.high, f64::INFINITY),
    )
}

/// A new default breaks a master if the bus depends on it: the device type, the
/// CAN-IDs in use, the times of frames and the contents of the PDOs.
pub(super) fn default(after: Dictionary<'_>, address: Address) -> Impact {
    let is_record = after
        .object(address.index)
        .is_some_and(|object| object.code.has_members());
    breaking(match (address.index, address.sub) {
        // Device type, vendor and product. Revision and serial number may differ.
        (0x1000, 0) | (0x1018, 1 | 2) => true,
        (0x1018, _) => false,
        (0x1005 | 0x1012 | 0x1014, 0) => true,
        (0x1200..=0x12FF, 1 | 2) => true,
        (0x1400..=0x15FF | 0x1800..=0x19FF, 1 | 2) => true,
        (0x1600..=0x17FF | 0x1A00..=0x1BFF, _) => true,
        // Bit rate and node ID of most devices are objects of the manufacturer. A count adds
        // no information to added and removed objects.
        (_, 0) if is_record => false,
        _ => false,
    })
}
