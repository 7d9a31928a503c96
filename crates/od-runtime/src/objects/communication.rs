//! Rules of CiA 301 for writing the communication objects.

use od_model::row::Row;
use od_model::typed::MapEntry;
use od_model::{Address, TransmissionType};

use crate::number::number_in;
use crate::profile::Profile;
use crate::services::{Services, may_change, may_have};
use crate::store::Store;
use crate::sync;
use od_wire::{AbortCode, CobId};

/// Signature that a download to 1010h or 1011h must contain, in the byte order of the bus.
pub(super) fn command(address: Address) -> Option<[u8; 4]> {
    match address {
        Address {
            index: 0x1010,
            sub: 1..,
        } => Some(*b"save"),
        Address {
            index: 0x1011,
            sub: 1..,
        } => Some(*b"load"),
        _ => None,
    }
}

/// Returns whether the address is the number of mapped objects of a PDO.
pub(super) const fn is_mapping_count(address: Address) -> bool {
    matches!(address.index, 0x1600..=0x17FF | 0x1A00..=0x1BFF) && address.sub == 0
}

/// Checks a value that a master writes to an object below 2000h. `bytes` has the entry's length.
pub(super) fn check<D: Services>(
    store: &Store<'_>,
    profile: &Profile,
    row: &Row,
    bytes: &[u8],
) -> Result<(), AbortCode> {
    let Address { index, sub } = row.address();
    // A value longer than a word (in another dictionary) is too great.
    let value = u32::try_from(number_in(bytes)).unwrap_or(u32::MAX);
    let check_cob_id = |has_valid_bit| check_cob_id(store, profile, row, value, has_valid_bit);
    let allow = |is_allowed| {
        if is_allowed {
            Ok(())
        } else {
            Err(AbortCode::ValueRange)
        }
    };
    // Each index has one arm, which asks itself whether the device has the object. As a guard, the
    // question would make the compiler generate code for all arms below.
    match (index, sub) {
        // Writing 0 clears the log; nothing else may be written (chapter 7.5.2.4).
        (0x1003, 0) => allow(!const { may_have::<D>(0x1003, 0x1003, None) } || value == 0),
        (0x1005, 0) => {
            // A device that produces no SYNC cannot have bit 30 set (chapter 7.5.2.5).
            allow(!CobId::new(value).produces_sync() || produces_sync::<D>(store))?;
            allow(!D::SYNC_PRODUCER || !is_in_use(store, index, value, PRODUCER))?;
            check_cob_id(false)
        }
        (0x1012, 0) => {
            if D::TIME {
                allow(!is_in_use(store, index, value, PRODUCER | CONSUMER))?;
                check_cob_id(false)?;
            }
            Ok(())
        }
        (0x1019, 0) => {
            if const { may_have::<D>(0x1019, 0x1019, None) } {
                allow(sync::is_overflow(value as u8))?;
                // A SYNC may be in transmission (chapter 7.5.2.22).
                if store.unsigned(0x1006, 0) != 0 {
                    return Err(AbortCode::DeviceState);
                }
            }
            Ok(())
        }
        // A node can be in one entry only (chapter 7.5.2.13).
        (0x1016, 1..) => {
            if D::CONSUMER && is_watched_elsewhere(store, sub, value) {
                Err(AbortCode::Incompatible)
            } else {
                Ok(())
            }
        }
        // CiA 301 reserves 03h to 7Fh; the bus-cover family uses 03h (chapter 7.5.2.32).
        (0x1029, 1..) => allow(!D::BEHAVIOUR || !matches!(value, 4..=0x7F)),
        (0x1014, 0) => check_cob_id(true),
        // An SDO exists while both COB-IDs are valid (chapter 7.5.2.33).
        (0x1201..=0x127F, 1 | 2) => {
            if D::SERVERS {
                check_cob_id(true)
            } else {
                Ok(())
            }
        }
        // The COB-IDs of a client have the same rules as those of a server (chapter 7.5.2.34).
        (0x1280..=0x12FF, 1 | 2) => {
            if const { may_have::<D>(0x1280, 0x12FF, None) } {
                check_cob_id(true)
            } else {
                Ok(())
            }
        }
        (0x1400..=0x15FF, _) => match sub {
            1 if D::RPDOS => check_cob_id(true),
            2 => allow(!D::RPDOS || !TransmissionType::new(value as u8).is_reserved(true)),
            _ => Ok(()),
        },
        (0x1800..=0x19FF, _) => match sub {
            1 => check_cob_id(true),
            2 => {
                let mut types = profile.pdo.tpdo_types.iter();
                allow(types.any(|(low, high)| (*low..=*high).contains(&(value as u8))))
            }
            // The inhibit time and the SYNC start value cannot change while the PDO exists (chapter 7.5.2.37).
            3 if const { may_have::<D>(0x1800, 0x19FF, Some(3)) } => {
                allow(may_be(store, profile, row, value))
            }
            6 if const { may_have::<D>(0x1800, 0x19FF, Some(6)) } => {
                allow(value <= 240 && may_be(store, profile, row, value))
            }
            _ => Ok(()),
        },
        (0x1600..=0x17FF | 0x1A00..=0x1BFF, _) => {
            if const { can_map::<D>() } {
                check_mapping(store, profile, row.address(), value)
            } else {
                Ok(())
            }
        }
        _ => Ok(()),
    }
}

/// Checks a value of a mapping object: the number of entries, or an entry.
fn check_mapping(
    store: &Store<'_>,
    profile: &Profile,
    Address { index, sub }: Address,
    value: u32,
) -> Result<(), AbortCode> {
    if sub == 0 {
        return check_mapping_count(store, index, value);
    }
    if store.word(index, 0, 0) != 0 {
        return Err(profile.sdo.mapping_in_use);
    }
    // A mapping entry of 0 can be written, but sub-index 0 cannot count it.
    match value {
        0 => Ok(()),
        _ => check_mapped(store, index, value),
    }
}

/// Bits of 1005h and 1012h.
const PRODUCER: u32 = 1 << 30;
const CONSUMER: u32 = 1 << 31;

/// Returns whether the device can produce SYNC: it needs a period (1006h).
fn produces_sync<D: Services>(store: &Store<'_>) -> bool {
    D::SYNC_PRODUCER && store.try_word(0x1006, 0).is_some()
}

/// Returns whether the mapping of a PDO can change.
const fn can_map<D: Services>() -> bool {
    may_change::<D>(0x1600, 0x17FF) || may_change::<D>(0x1A00, 0x1BFF)
}

/// Returns whether one of these bits is set and stays set, and the CAN-ID would change.
fn is_in_use(store: &Store<'_>, index: u16, new: u32, bits: u32) -> bool {
    let old = store.word(index, 0, 0);
    old & bits != 0 && new & bits != 0 && (old ^ new) & 0x3FFF_FFFF != 0
}

/// Returns whether another sub-index of 1016h than `sub` monitors the node of `value`.
fn is_watched_elsewhere(store: &Store<'_>, sub: u8, value: u32) -> bool {
    let (node, time) = (value >> 16 & 0xFF, value & 0xFFFF);
    let mut others = (1..0x80).filter(|other| *other != sub);
    let same = |other: u8| {
        let entry = store.word(0x1016, other, 0);
        entry >> 16 & 0xFF == node && entry & 0xFFFF != 0
    };
    time != 0 && (1..=127).contains(&node) && others.any(same)
}

/// Checks a COB-ID: its bits are consistent, CiA 301 does not restrict the CAN-ID, and it changes
/// only while bit 31 is set (unless the family allows more).
fn check_cob_id(
    store: &Store<'_>,
    profile: &Profile,
    row: &Row,
    new: u32,
    has_valid_bit: bool,
) -> Result<(), AbortCode> {
    let (old, new) = (CobId::new(store.number_of(row) as u32), CobId::new(new));
    let valid = new.is_valid() || !has_valid_bit;
    if !new.is_consistent() || (valid && is_restricted(row.address().index, new)) {
        return Err(AbortCode::ValueRange);
    }
    let same = (new.raw() ^ old.raw()) & 0x3FFF_FFFF == 0;
    if has_valid_bit && !profile.pdo.direct_cob_id && old.is_valid() && valid && !same {
        return Err(AbortCode::ValueRange);
    }
    Ok(())
}

/// Returns whether CiA 301 restricts this CAN-ID for the service at `index`. An SDO client may have those of
/// the default SDO of another node (chapter 7.5.2.34).
fn is_restricted(index: u16, cob_id: CobId) -> bool {
    let is_client = matches!(index, 0x1280..=0x12FF);
    let is_sdo = || {
        matches!(
            cob_id.can_id().as_standard(),
            Some(0x581..=0x5FF | 0x601..=0x67F)
        )
    };
    cob_id.is_restricted() && !(is_client && is_sdo())
}

/// Returns whether the PDO of a communication parameter is valid (bit 31 of its COB-ID is 0).
fn is_valid(store: &Store<'_>, parameter: u16) -> bool {
    CobId::new(store.word(parameter, 1, 1 << 31)).is_valid()
}

/// Returns whether a communication parameter of a PDO may have this value now: the one that it has, or any
/// while the PDO is not valid (unless the family allows more).
fn may_be(store: &Store<'_>, profile: &Profile, row: &Row, value: u32) -> bool {
    let is_free = profile.pdo.direct_cob_id || !is_valid(store, row.address().index);
    is_free || store.number_of(row) as u32 == value
}

/// Checks sub-index 0 of a mapping: 0 disables the mapping; a higher value needs as many entries
/// that exist, can be mapped, and together fit into a frame (chapter 7.5.2.36).
fn check_mapping_count(store: &Store<'_>, index: u16, count: u32) -> Result<(), AbortCode> {
    let mut bits = 0;
    for sub in 1..count.min(0xFF) + 1 {
        let raw = store.try_word(index, sub as u8);
        let raw = raw.ok_or(AbortCode::PdoTooLong)?;
        check_mapped(store, index, raw)?;
        bits += u32::from(MapEntry::parse(raw).bits);
        if bits > 64 {
            return Err(AbortCode::PdoTooLong);
        }
    }
    Ok(())
}

/// Checks one entry of the mapping object at `index`: the mapped object exists, can be mapped in
/// this direction, and the length is its own. An RPDO may map the dummies 0001h to 0007h.
pub(crate) fn check_mapped(store: &Store<'_>, index: u16, raw: u32) -> Result<(), AbortCode> {
    let mapped = MapEntry::parse(raw);
    let transmits = index >= 0x1A00;
    if let Address {
        index: dummy @ 0x0001..=0x0007,
        sub: 0,
    } = mapped.address
    {
        let bits = match dummy {
            1 => 1,
            2 | 5 => 8,
            3 | 6 => 16,
            _ => 32,
        };
        return if !transmits && bits == mapped.bits {
            Ok(())
        } else {
            Err(AbortCode::NotMappable)
        };
    }
    let row = store.row(mapped.address)?;
    let direction = if transmits {
        row.maps_to_tpdo()
    } else {
        row.maps_to_rpdo()
    };
    if direction && !row.is_variable() && row.bits() == mapped.bits {
        Ok(())
    } else {
        Err(AbortCode::NotMappable)
    }
}

#[cfg(test)]
mod tests {
    use super::can_map;
    use crate::services::tests::{AnyDevice, Known, Rich};

    #[test]
    fn one_changeable_mapping_is_enough() {
        assert!(can_map::<AnyDevice>());
        assert!(can_map::<Known>());
        assert!(!can_map::<Rich>());
    }
}
