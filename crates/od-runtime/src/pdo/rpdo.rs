//! One RPDO: its configuration, and the frame that it receives (CiA 301, chapter 7.2.2.5.1, objects
//! 1400h to 17FFh).

use super::mapping::{Mapped, Mapping};
use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::objects::Objects;
use crate::services::Services;
use od_model::TransmissionType;
use od_wire::{CanId, CobId, Frame, Instant};

/// An RPDO: its configuration, and a frame that waits for SYNC.
#[derive(Clone, Debug)]
pub struct Rpdo {
    valid: bool,
    /// The object is valid, but no service may have its CAN-ID.
    refused: bool,
    synchronous: bool,
    cob_id: CobId,
    mapping: Mapping,
    waiting: Option<[u8; 8]>,
    /// Longest time between two frames, in milliseconds; 0: not monitored (sub-index 5).
    event_ms: u16,
    /// Time when the next frame is late. Monitoring begins with the first frame.
    late_at: Deadline,
    /// The next frame is late.
    is_late: bool,
}

impl Blank for Rpdo {
    const BLANK: Self = Self {
        valid: false,
        refused: false,
        synchronous: false,
        cob_id: CobId::new(0),
        mapping: Mapping::NONE,
        waiting: None,
        event_ms: 0,
        late_at: Deadline::NEVER,
        is_late: false,
    };
}

impl Rpdo {
    /// Reads the objects of RPDO `number` again; its mapping entries are in `mapped` from `first`
    /// on. A frame that waits for SYNC stays if the objects have not changed. Returns whether the
    /// RPDO has become refused: no service may have its CAN-ID.
    pub(crate) fn configure<D: Services>(
        &mut self,
        objects: &Objects<'_, D>,
        number: u16,
        first: usize,
        mapped: &mut [Mapped],
    ) -> bool {
        let parameter = 0x1400 + number;
        let store = &objects.store;
        let cob_id = CobId::new(store.word(parameter, 1, 1 << 31));
        let kind = TransmissionType::new(store.word(parameter, 2, 0) as u8);
        let synchronous = kind.is_synchronous();
        let event_ms = if D::DEADLINES {
            store.word(parameter, 5, 0) as u16
        } else {
            0
        };
        let changed = self.mapping.load(objects, 0x1600 + number, first, mapped);
        if changed || (cob_id, synchronous) != (self.cob_id, self.synchronous) {
            self.waiting = None;
        }
        if (cob_id, event_ms) != (self.cob_id, self.event_ms) {
            (self.late_at, self.is_late) = (Deadline::NEVER, false);
        }
        let is_on = cob_id.is_valid() && self.mapping.len() > 0;
        let is_usable = cob_id.usable_id().is_some();
        let is_news = is_on && !is_usable && !(self.refused && cob_id == self.cob_id);
        (self.valid, self.refused) = (is_on && is_usable, is_on && !is_usable);
        (self.cob_id, self.synchronous) = (cob_id, synchronous);
        self.event_ms = event_ms;
        is_news
    }

    /// CAN-ID of its frames.
    pub(crate) fn received_by(&self) -> Option<CanId> {
        self.valid.then(|| self.cob_id.can_id())
    }

    /// Writes the values of a frame, at once or with the next SYNC. Returns whether the frame is as long as the
    /// mapping; a shorter one writes nothing (EMCY 8210h).
    pub(crate) fn receive<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
        frame: &Frame,
    ) -> bool {
        if frame.dlc() < self.mapping.len() {
            return false;
        }
        if D::DEADLINES && self.event_ms > 0 {
            self.late_at = Deadline::at(objects.now.plus_millis(self.event_ms.into()));
            self.is_late = false;
        }
        if self.synchronous {
            self.waiting = Some(*frame.bytes());
        } else {
            self.mapping.apply(objects, mapped, *frame.bytes());
        }
        true
    }

    /// Handles SYNC: processes a frame that waits.
    pub(crate) fn sync<D: Services>(&mut self, objects: &mut Objects<'_, D>, mapped: &[Mapped]) {
        if let Some(data) = self.waiting.take() {
            self.mapping.apply(objects, mapped, data);
        }
    }

    /// Returns whether its frame has become late (CiA 301, object 1400h, sub-index 5): EMCY 8250h.
    pub(crate) fn handle_timeout(&mut self, now: Instant) -> bool {
        let is_due = self.late_at.is_due(now);
        if is_due {
            (self.late_at, self.is_late) = (Deadline::NEVER, true);
        }
        is_due
    }

    /// Returns whether its frame is late.
    pub(crate) fn is_late(&self) -> bool {
        self.is_late
    }

    /// Time when the next frame is late.
    pub(crate) fn deadline(&self) -> Deadline {
        self.late_at
    }

    /// Stops at the end of Operational.
    pub(crate) fn stop(&mut self) {
        self.waiting = None;
        (self.late_at, self.is_late) = (Deadline::NEVER, false);
    }
}
