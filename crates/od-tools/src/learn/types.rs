//! The type of a value: from the standards, the profile, or the value that the node has.

use od_eds::outline::data_type;
use od_model::{Address, DataType, Kind};

use super::known::Profiles;
use super::probe::{FoundObject, Room};

/// The type of a value, and its source.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Guess {
    pub(super) data_type: DataType,
    pub(super) from: From,
}

/// Source of a type, from the least to the most reliable.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum From {
    /// The length of the value only.
    Length,
    /// The value: text, a short decimal fraction, a small negative number.
    Value,
    /// A standard or a profile.
    Standard,
}

/// The types of the values of one object.
pub(super) fn types(
    profiles: &Profiles,
    found: &[FoundObject],
    is_whole: bool,
    version: u16,
) -> Vec<Guess> {
    let mut all: Vec<Guess> = found
        .iter()
        .map(|one| guess(profiles, one, is_whole, version))
        .collect();
    // If all members have the same length, the type that one value shows is the type of all.
    let rest = usize::from(!is_whole && found.first().is_some_and(|one| one.address.sub == 0));
    let members = &all[rest.min(all.len())..];
    let size = members.first().and_then(|one| one.data_type.size());
    let is_even = members.iter().all(|one| one.data_type.size() == size);
    let shown = members.iter().find(|one| one.from == From::Value).copied();
    if let (true, Some(shown)) = (is_even && size.is_some(), shown) {
        let unsure = all[rest..]
            .iter_mut()
            .filter(|one| one.from == From::Length);
        unsure.for_each(|one| *one = shown);
    }
    all
}

fn guess(profiles: &Profiles, one: &FoundObject, is_whole: bool, version: u16) -> Guess {
    let Address { index, sub } = one.address;
    let sure = |data_type| Guess {
        data_type,
        from: From::Standard,
    };
    if let Some(known) = data_type(index, sub, is_whole).filter(|known| fits(*known, one)) {
        return sure(known);
    }
    if sub == 0 && !is_whole {
        return sure(DataType::Unsigned8);
    }
    let of_profile = profiles.types(index, sub);
    // The offset of an encoder became a number with a sign in version 3 of CiA 406.
    if index == 0x6509 && (1..0x300).contains(&version) && of_profile.len() > 1 {
        return sure(DataType::Unsigned32);
    }
    if let Some(known) = of_profile.iter().find(|known| fits(**known, one)) {
        return sure(*known);
    }
    let shown = by_value(one);
    // A number of another length than the profile has is still one with or without sign.
    let signed = of_profile.iter().any(|known| known.kind() == Kind::Signed);
    match shown.from {
        From::Length if signed => match with_sign(shown.data_type) {
            Some(data_type) => Guess {
                data_type,
                from: From::Value,
            },
            None => shown,
        },
        _ => shown,
    }
}

/// Returns whether the value has the length of the type.
fn fits(data_type: DataType, found: &FoundObject) -> bool {
    match (&found.bytes, data_type.size(), found.room) {
        (Some(bytes), Some(size), _) => bytes.len() == size,
        (None, Some(size), Some(Room::Bytes(room))) => room == size,
        (None, Some(_), Some(Room::Any | Room::Some)) => false,
        (Some(bytes), None, _) => bytes.len() != 1 && found.room != Some(Room::Bytes(bytes.len())),
        _ => true,
    }
}

fn by_value(found: &FoundObject) -> Guess {
    let length = |data_type| Guess {
        data_type,
        from: From::Length,
    };
    let shown = |data_type| Guess {
        data_type,
        from: From::Value,
    };
    let bytes = match (&found.bytes, found.room) {
        (_, Some(Room::Any)) => return length(DataType::Domain),
        (Some(bytes), _) if !bytes.is_empty() => bytes,
        (_, Some(Room::Bytes(size))) => {
            return length(number(size).unwrap_or(DataType::Unsigned32));
        }
        (Some(_), _) | (None, Some(Room::Some)) => return length(DataType::OctetString),
        _ => return length(DataType::Unsigned32),
    };
    // Strings may end with zeros.
    let text = bytes.len() - bytes.iter().rev().take_while(|byte| **byte == 0).count();
    let is_printable = |byte: &u8| (0x20..0x7F).contains(byte);
    let is_text = text > 0 && bytes[..text].iter().all(is_printable);
    let is_number = found.room == Some(Room::Bytes(bytes.len()));
    let is_string = found.room == Some(Room::Some);
    match bytes.len() {
        _ if is_text && is_string => shown(DataType::VisibleString),
        _ if is_string => length(DataType::OctetString),
        3.. if is_text && text > 2 && !is_number => shown(DataType::VisibleString),
        1 => length(DataType::Unsigned8),
        2 => {
            let value = i16::from_le_bytes([bytes[0], bytes[1]]);
            // Close to zero from below, or the largest number that a sign leaves.
            if (-0x2000..-1).contains(&value) || matches!(value, 0x7FFF | -0x7FFF) {
                shown(DataType::Integer16)
            } else {
                length(DataType::Unsigned16)
            }
        }
        4 => {
            let raw = [bytes[0], bytes[1], bytes[2], bytes[3]];
            let value = i32::from_le_bytes(raw);
            if (-0x0100_0000..-1).contains(&value) || matches!(value, 0x7FFF_FFFF | -0x7FFF_FFFF) {
                shown(DataType::Integer32)
            } else if is_real(f32::from_le_bytes(raw)) {
                shown(DataType::Real32)
            } else {
                length(DataType::Unsigned32)
            }
        }
        size => match number(size) {
            Some(data_type) if is_number || matches!(size, 3 | 8) => length(data_type),
            _ => length(DataType::OctetString),
        },
    }
}

/// Returns whether the number is a short decimal fraction, such as 0.25.
fn is_real(value: f32) -> bool {
    let size = value.abs();
    (1e-5..1e8).contains(&size) && format!("{size}").len() <= 7
}

/// The unsigned integer type of this many bytes.
fn number(size: usize) -> Option<DataType> {
    Some(match size {
        1 => DataType::Unsigned8,
        2 => DataType::Unsigned16,
        3 => DataType::Unsigned24,
        4 => DataType::Unsigned32,
        5 => DataType::Unsigned40,
        6 => DataType::Unsigned48,
        7 => DataType::Unsigned56,
        8 => DataType::Unsigned64,
        _ => return None,
    })
}

/// The signed type with the length of an unsigned one.
pub(super) fn with_sign(data_type: DataType) -> Option<DataType> {
    Some(match data_type {
        DataType::Unsigned8 => DataType::Integer8,
        DataType::Unsigned16 => DataType::Integer16,
        DataType::Unsigned24 => DataType::Integer24,
        DataType::Unsigned32 => DataType::Integer32,
        DataType::Unsigned40 => DataType::Integer40,
        DataType::Unsigned48 => DataType::Integer48,
        DataType::Unsigned56 => DataType::Integer56,
        DataType::Unsigned64 => DataType::Integer64,
        _ => return None,
    })
}
