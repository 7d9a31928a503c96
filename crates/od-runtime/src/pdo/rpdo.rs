//! One RPDO: when it acts, and on which objects (CiA 301, chapter 7.2.2.5.1, objects 1400h to 17FFh).

use super::mapping::{Mapped, Mapping};
use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::objects::Objects;
use crate::services::Services;
use od_wire::{CanId, CobId, Frame, Instant};

/// An RPDO with what its objects say, and a frame that waits for SYNC.
#[derive(Clone, Debug)]
pub struct Rpdo {
    valid: bool,
    /// Its objects make it valid, and its CAN-ID does not.
    refused: bool,
    synchronous: bool,
    cob_id: CobId,
    mapping: Mapping,
    waiting: Option<[u8; 8]>,
    /// Longest time between two frames, in milliseconds; 0: it is not watched (sub-index 5).
    event_ms: u16,
    /// The next frame is late then. Watching begins with a first frame.
    late_at: Deadline,
    /// It is late.
    is_late: bool,
}

/// Result of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Received {
    /// It was processed, or waits for SYNC.
    Taken,
    /// It is shorter than the mapping: EMCY 8210h.
    TooShort,
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
    /// Reads the objects of RPDO `number` again; its mapping entries are in `mapped` from `first` on. A frame that
    /// waits for SYNC stays where the objects say what they said before. Returns whether the PDO is refused now and
    /// was not before: no service may have its CAN-ID.
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
        let synchronous = store.word(parameter, 2, 0) <= 240;
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

    /// CAN-ID of the frames that it receives.
    pub(crate) fn received_by(&self) -> Option<CanId> {
        self.valid.then(|| self.cob_id.can_id())
    }

    /// Its frame came.
    pub(crate) fn receive<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
        frame: &Frame,
    ) -> Received {
        if frame.dlc() < self.mapping.len() {
            return Received::TooShort;
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
        Received::Taken
    }

    /// SYNC came: a frame that waits acts now.
    pub(crate) fn sync<D: Services>(&mut self, objects: &mut Objects<'_, D>, mapped: &[Mapped]) {
        if let Some(data) = self.waiting.take() {
            self.mapping.apply(objects, mapped, data);
        }
    }

    /// Returns whether its frame is late from now on (CiA 301, object 1400h, sub-index 5): EMCY 8250h.
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

    /// Operational ends.
    pub(crate) fn stop(&mut self) {
        self.waiting = None;
        (self.late_at, self.is_late) = (Deadline::NEVER, false);
    }
}
