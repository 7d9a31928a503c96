//! One RPDO: when it acts, and on which objects.

use super::mapping::Mapping;
use crate::device::Device;
use crate::objects::Objects;
use crate::rooms::{Blank, Rooms};
use od_wire::{CanId, CobId, Frame};

/// An RPDO with what its objects say, and a frame that waits for SYNC.
#[derive(Clone, Debug)]
pub(crate) struct Rpdo<R: Rooms> {
    valid: bool,
    /// Its objects make it valid, and its CAN-ID does not.
    refused: bool,
    cob_id: CobId,
    synchronous: bool,
    mapping: Mapping<R>,
    waiting: Option<[u8; 8]>,
}

/// Result of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Received {
    /// It was processed, or waits for SYNC.
    Taken,
    /// It is shorter than the mapping: EMCY 8210h.
    TooShort,
}

impl<R: Rooms> Blank for Rpdo<R> {
    const BLANK: Self = Self {
        valid: false,
        refused: false,
        cob_id: CobId::new(0),
        synchronous: false,
        mapping: Mapping::NONE,
        waiting: None,
    };
}

impl<R: Rooms> Rpdo<R> {
    /// Reads the objects of RPDO `number` again; a frame that waits for SYNC stays where
    /// they say what they said. Returns whether the PDO is refused anew: no service may have its CAN-ID.
    pub(crate) fn configure<D: Device>(&mut self, objects: &Objects<'_, D>, number: u16) -> bool {
        let parameter = 0x1400 + number;
        let store = &objects.store;
        let cob_id = CobId::new(store.word(parameter, 1, 1 << 31));
        let synchronous = store.word(parameter, 2, 0) <= 240;
        let changed = self.mapping.load(objects, 0x1600 + number);
        if changed || (cob_id, synchronous) != (self.cob_id, self.synchronous) {
            self.waiting = None;
        }
        let is_on = cob_id.is_valid() && self.mapping.len() > 0;
        let is_usable = cob_id.usable_id().is_some();
        let is_news = is_on && !is_usable && !(self.refused && cob_id == self.cob_id);
        (self.valid, self.refused) = (is_on && is_usable, is_on && !is_usable);
        (self.cob_id, self.synchronous) = (cob_id, synchronous);
        is_news
    }

    /// Whether it receives frames with this CAN-ID.
    #[inline]
    pub(crate) fn takes(&self, id: CanId) -> bool {
        self.valid && self.cob_id.can_id() == id
    }

    /// CAN-ID of the frames that it receives.
    pub(crate) fn received_by(&self) -> Option<CanId> {
        self.valid.then(|| self.cob_id.can_id())
    }

    /// Its frame came.
    pub(crate) fn receive<D: Device>(
        &mut self,
        objects: &mut Objects<'_, D>,
        frame: &Frame,
    ) -> Received {
        if frame.dlc() < self.mapping.len() {
            return Received::TooShort;
        }
        if self.synchronous {
            self.waiting = Some(*frame.bytes());
        } else {
            self.mapping.apply(objects, *frame.bytes());
        }
        Received::Taken
    }

    /// SYNC came: a waiting frame acts now.
    pub(crate) fn sync<D: Device>(&mut self, objects: &mut Objects<'_, D>) {
        if let Some(data) = self.waiting.take() {
            self.mapping.apply(objects, data);
        }
    }

    /// Whether a frame waits for SYNC.
    #[inline(always)]
    pub(crate) fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Operational ends.
    pub(crate) fn stop(&mut self) {
        self.waiting = None;
    }
}
