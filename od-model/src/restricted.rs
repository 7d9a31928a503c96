//! CAN-IDs that no PDO, SYNC, TIME or EMCY may use (CiA 301, table of restricted CAN-IDs).

use core::ops::RangeInclusive;

/// Owner of a restricted CAN-ID.
///
/// ```
/// use od_model::{CanIdOwner, restricted};
///
/// let (range, owner) = restricted(0x605).expect("it belongs to the default SDO");
/// assert_eq!((range, owner), (0x601..=0x67F, CanIdOwner::SdoRequest));
/// assert!(restricted(0x185).is_none());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CanIdOwner {
    /// NMT commands, 000h.
    Nmt,
    /// Responses of the default SDO, 581h–5FFh.
    SdoResponse,
    /// Requests to the default SDO, 601h–67Fh.
    SdoRequest,
    /// Boot-up, heartbeat and node guarding, 701h–77Fh.
    ErrorControl,
    /// LSS and CAN-IDs that CiA reserves, 780h–7FFh.
    Lss,
    /// CAN-IDs that CiA reserves: 001h–07Fh, 101h–180h, 6E0h–6FFh.
    Reserved,
}

impl CanIdOwner {
    /// The owner as text that completes "CiA 301 reserves it for …".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nmt => "NMT",
            Self::SdoResponse => "the default SDO (server to client)",
            Self::SdoRequest => "the default SDO (client to server)",
            Self::ErrorControl => "NMT error control",
            Self::Lss => "LSS and later use",
            Self::Reserved => "later use",
        }
    }
}

/// Returns the owner of a restricted 11-bit CAN-ID and the range around it; `None` for any other CAN-ID.
pub const fn restricted(can_id: u32) -> Option<(RangeInclusive<u32>, CanIdOwner)> {
    Some(match can_id {
        0x000 => (0x000..=0x000, CanIdOwner::Nmt),
        0x001..=0x07F => (0x001..=0x07F, CanIdOwner::Reserved),
        0x101..=0x180 => (0x101..=0x180, CanIdOwner::Reserved),
        0x581..=0x5FF => (0x581..=0x5FF, CanIdOwner::SdoResponse),
        0x601..=0x67F => (0x601..=0x67F, CanIdOwner::SdoRequest),
        0x6E0..=0x6FF => (0x6E0..=0x6FF, CanIdOwner::Reserved),
        0x701..=0x77F => (0x701..=0x77F, CanIdOwner::ErrorControl),
        0x780..=0x7FF => (0x780..=0x7FF, CanIdOwner::Lss),
        _ => return None,
    })
}

/// Returns whether CiA 301 keeps an 11-bit CAN-ID for NMT, SDO, error control, LSS or later use.
pub const fn is_restricted(can_id: u32) -> bool {
    restricted(can_id).is_some()
}

#[cfg(test)]
mod tests {
    use super::{CanIdOwner, is_restricted, restricted};

    #[test]
    fn the_gaps_between_the_services_are_free() {
        for free in [
            0x080, 0x100, 0x181, 0x57F, 0x580, 0x600, 0x680, 0x6DF, 0x700, 0x800,
        ] {
            assert!(!is_restricted(free), "{free:X}");
        }
        for kept in [
            0x000, 0x001, 0x101, 0x180, 0x581, 0x601, 0x6E0, 0x701, 0x7E5, 0x7FF,
        ] {
            assert!(is_restricted(kept), "{kept:X}");
        }
    }

    #[test]
    fn a_range_holds_the_can_ids_of_its_owner_and_no_other() {
        for id in 0..0x800 {
            if let Some((range, owner)) = restricted(id) {
                assert!(range.contains(&id), "{id:X}");
                assert!(
                    range
                        .clone()
                        .all(|other| restricted(other) == Some((range.clone(), owner)))
                );
            }
        }
        assert_eq!(
            restricted(0x67F).map(|(_, owner)| owner),
            Some(CanIdOwner::SdoRequest)
        );
        assert_eq!(restricted(0).map(|(_, owner)| owner.name()), Some("NMT"));
    }
}
