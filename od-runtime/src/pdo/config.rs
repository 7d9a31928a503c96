//! Configuration of a TPDO: what its communication parameter says.

use crate::device::{Device, may_have};
use crate::objects::Objects;
use od_wire::{CanId, CobId};

/// Transmission types of CiA 301 (table 72).
pub(super) mod kind {
    pub(in crate::pdo) const ACYCLIC: u8 = 0;
    pub(in crate::pdo) const LAST_CYCLIC: u8 = 240;
    pub(in crate::pdo) const SYNC_RTR: u8 = 252;
    pub(in crate::pdo) const RTR: u8 = 253;
    pub(in crate::pdo) const EVENT_FIRST: u8 = 254;
}

/// Parameters that a TPDO of the device may have.
pub(super) trait Parameters: Device + Sized {
    const INHIBITED: bool = may_have::<Self>(0x1800, 0x19FF, Some(3));
    const TIMED: bool = may_have::<Self>(0x1800, 0x19FF, Some(5));
    const STARTED: bool = may_have::<Self>(0x1800, 0x19FF, Some(6));
    /// The repeat counter of a family.
    const REPEATED: bool = match Self::PROFILE {
        Some(profile) => profile.pdo.repeat_counter.is_some(),
        None => true,
    };
}

impl<D: Device> Parameters for D {}

/// Whether a TPDO is sent.
#[derive(Clone, Copy, PartialEq, PartialOrd, Debug)]
pub(super) enum Validity {
    /// Never.
    Off,
    /// Never, whatever bit 31 says: no service may have the CAN-ID, or another one sends by it.
    Refused,
    On,
    /// A remote frame requests it, too.
    Requested,
}

/// Configuration of a TPDO, from its objects.
#[derive(Clone, Copy, Debug)]
pub(super) struct Config {
    pub(super) validity: Validity,
    pub(super) kind: u8,
    pub(super) repeat: u8,
    pub(super) sync_start: u8,
    pub(super) id: CanId,
    /// In milliseconds.
    pub(super) event: u32,
    /// In units of 100 µs.
    pub(super) inhibit: u32,
}

impl Config {
    pub(super) const NONE: Self = Self {
        validity: Validity::Off,
        kind: 0,
        repeat: 0,
        sync_start: 0,
        id: CanId::standard(0),
        event: 0,
        inhibit: 0,
    };

    /// Whether it says the same as another one. Word by word: that is less code than field by field.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let words = |it: &Self| {
            let bytes = [it.kind, it.repeat, it.sync_start, it.validity as u8];
            let [event, inhibit] = [it.event, it.inhibit];
            [it.id.raw(), event, inhibit, u32::from_le_bytes(bytes)]
        };
        let both = words(self).into_iter().zip(words(other));
        both.fold(0, |bits, (one, other)| bits | one ^ other) == 0
    }

    /// Reads the objects of TPDO `number`, but for its mapping. `is_taken` knows the CAN-IDs by which other services send.
    #[inline(never)]
    pub(super) fn load<D: Device>(
        objects: &Objects<'_, D>,
        number: u16,
        is_taken: &dyn Fn(CanId) -> bool,
    ) -> Self {
        let parameter = 0x1800 + number;
        let store = &objects.store;
        let word = |may_be_there, sub| match may_be_there {
            true => store.word(parameter, sub, 0),
            false => 0,
        };
        let cob_id = CobId::new(store.word(parameter, 1, 1 << 31));
        let repeat = objects
            .profile()
            .pdo
            .repeat_counter
            .map(|first| first + number);
        let kind = store.word(parameter, 2, 0) as u8;
        let sync_only = objects
            .profile()
            .pdo
            .sync_only
            .is_some_and(|(index, bits)| store.word(index, 0, 0) & bits == bits);
        let allowed = kind <= kind::LAST_CYCLIC || !sync_only;
        Self {
            validity: match cob_id.usable_id() {
                _ if !(cob_id.is_valid() && allowed) => Validity::Off,
                None => Validity::Refused,
                Some(id) if is_taken(id) => Validity::Refused,
                Some(_) if cob_id.allows_rtr() => Validity::Requested,
                Some(_) => Validity::On,
            },
            kind,
            repeat: repeat.map_or(0, |index| store.word(index, 0, 0) as u8),
            sync_start: word(D::STARTED, 6) as u8,
            id: cob_id.can_id(),
            event: word(D::TIMED, 5),
            inhibit: word(D::INHIBITED, 3),
        }
    }
}
