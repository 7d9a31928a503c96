//! One TPDO: when it is sent, and with what (CiA 301, chapter 7.2.2.3, objects 1800h to 1BFFh).

use super::mapping::{Mapped, Mapping};
use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::objects::Objects;
use crate::profile::EventTimer;
use crate::services::Services;
use od_wire::{CanId, CobId, Frame, Instant};

/// Transmission types of CiA 301 (table 72).
mod kind {
    pub(super) const ACYCLIC: u8 = 0;
    pub(super) const LAST_CYCLIC: u8 = 240;
    pub(super) const SYNC_RTR: u8 = 252;
    pub(super) const RTR: u8 = 253;
    pub(super) const EVENT_FIRST: u8 = 254;
}

/// Whether a TPDO is sent.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Validity {
    /// Never.
    Off,
    /// Never, although bit 31 says so: no service may have the CAN-ID, or another service sends with it.
    Refused,
    On,
    /// A remote frame requests it, too.
    Requested,
}

/// Configuration of a TPDO, from its communication parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Config {
    validity: Validity,
    kind: u8,
    repeat: u8,
    sync_start: u8,
    id: CanId,
    /// In milliseconds.
    event: u32,
    /// In units of 100 µs.
    inhibit: u32,
}

/// TPDO: its configuration and its state.
#[derive(Clone, Debug)]
pub struct Tpdo {
    config: Config,
    mapping: Mapping,
    /// The next tick of the event timer.
    event_at: Deadline,
    inhibited_until: Instant,
    /// To be sent as soon as the inhibit time allows.
    pending: bool,
    /// The event timer alone is the reason why it is pending.
    by_timer: bool,
    /// SYNCs since the last transmission.
    syncs: u8,
    /// Waits for the SYNC whose counter is `sync_start`.
    waits_for_start: bool,
    /// Transmissions of this value that the repeat counter still allows.
    repeats_left: u8,
    /// Data that was sampled or sent last.
    last: [u8; 8],
    sampled: bool,
}

impl Blank for Tpdo {
    const BLANK: Self = Self {
        config: Config {
            validity: Validity::Off,
            kind: 0,
            repeat: 0,
            sync_start: 0,
            id: CanId::standard(0),
            event: 0,
            inhibit: 0,
        },
        mapping: Mapping::NONE,
        event_at: Deadline::NEVER,
        inhibited_until: Instant::ZERO,
        pending: false,
        by_timer: false,
        syncs: 0,
        waits_for_start: false,
        repeats_left: 0,
        last: [0; 8],
        sampled: false,
    };
}

impl Config {
    /// Reads the communication parameter of TPDO `number`. `is_taken` knows the CAN-IDs by which other services
    /// send.
    fn load<D: Services>(
        objects: &Objects<'_, D>,
        number: u16,
        is_taken: &dyn Fn(CanId) -> bool,
    ) -> Self {
        let profile = &objects.profile.pdo;
        let word = |index, sub| objects.store.word(index, sub, 0);
        let parameter = 0x1800 + number;
        let cob_id = CobId::new(objects.store.word(parameter, 1, 1 << 31));
        let kind = word(parameter, 2) as u8;
        let is_sync_only = profile
            .sync_only
            .is_some_and(|(index, bits)| word(index, 0) & bits == bits);
        let is_allowed = kind <= kind::LAST_CYCLIC || !is_sync_only;
        let repeat = profile.repeat_counter.map(|first| first + number);
        Self {
            validity: match cob_id.usable_id() {
                _ if !(cob_id.is_valid() && is_allowed) => Validity::Off,
                None => Validity::Refused,
                Some(id) if is_taken(id) => Validity::Refused,
                Some(_) if cob_id.allows_rtr() => Validity::Requested,
                Some(_) => Validity::On,
            },
            kind,
            repeat: repeat.map_or(0, |index| word(index, 0) as u8),
            sync_start: word(parameter, 6) as u8,
            id: cob_id.can_id(),
            event: word(parameter, 5),
            inhibit: word(parameter, 3),
        }
    }
}

impl Tpdo {
    /// Reads the objects of TPDO `number` (0 is 1800h and 1A00h) again; its mapping entries are in `mapped` from
    /// `first` on, and `is_taken` knows the CAN-IDs by which other services send. Returns whether the objects say
    /// something else than before; only then the TPDO restarts.
    pub(crate) fn configure<D: Services>(
        &mut self,
        objects: &Objects<'_, D>,
        number: u16,
        first: usize,
        mapped: &mut [Mapped],
        is_taken: &dyn Fn(CanId) -> bool,
    ) -> bool {
        let mut config = Config::load(objects, number, is_taken);
        let is_mapping_new = self.mapping.load(objects, 0x1A00 + number, first, mapped);
        if self.mapping.len() == 0 {
            config.validity = Validity::Off;
        }
        let changed = is_mapping_new || config != self.config;
        if changed {
            *self = Self {
                config,
                mapping: self.mapping.clone(),
                ..Self::BLANK
            };
        }
        changed
    }

    fn is_valid(&self) -> bool {
        matches!(self.config.validity, Validity::On | Validity::Requested)
    }

    /// Returns whether its objects make it valid, and its CAN-ID does not.
    pub(crate) fn is_refused(&self) -> bool {
        self.config.validity == Validity::Refused
    }

    /// CAN-ID of its frames, while it is valid.
    pub(crate) fn sent_by(&self) -> Option<CanId> {
        self.is_valid().then_some(self.config.id)
    }

    fn is_cyclic(&self) -> bool {
        (1..=kind::LAST_CYCLIC).contains(&self.config.kind)
    }

    fn is_event_driven(&self) -> bool {
        self.config.kind >= kind::EVENT_FIRST
    }

    /// Operational begins: the first period of the event timer, the first SYNC.
    pub(crate) fn start<D: Services>(&mut self, objects: &mut Objects<'_, D>, mapped: &[Mapped]) {
        self.syncs = 0;
        self.pending = false;
        self.repeats_left = self.config.repeat;
        self.waits_for_start = self.config.sync_start != 0;
        self.sampled = false;
        self.inhibited_until = objects.now;
        self.event_at = Deadline::NEVER;
        if self.is_valid() && self.is_event_driven() && self.config.event > 0 {
            self.event_at = Deadline::at(objects.now.plus_millis(self.config.event.into()));
        }
        if self.is_valid() {
            self.last = self.mapping.sample(objects, mapped);
        }
    }

    /// Operational begins: a family that sends changes sends the first values at once.
    pub(crate) fn announce<D: Services>(&mut self, objects: &Objects<'_, D>) {
        let sends_changes = objects.profile.pdo.event_on_change;
        self.pending |= sends_changes && self.is_valid() && self.is_event_driven();
    }

    /// Operational ends.
    pub(crate) fn stop(&mut self) {
        self.event_at = Deadline::NEVER;
        self.pending = false;
    }

    /// CAN-ID of the remote frame that requests it.
    pub(crate) fn requested_by(&self) -> Option<CanId> {
        (self.config.validity == Validity::Requested).then_some(self.config.id)
    }

    /// A remote frame requests it. A synchronous TPDO responds with the values of the last SYNC.
    pub(crate) fn request<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) -> Option<Frame> {
        if self.config.kind <= kind::SYNC_RTR {
            if !self.sampled {
                self.last = self.mapping.sample(objects, mapped);
            }
            return Some(self.frame(self.last));
        }
        self.pending = true;
        None
    }

    /// SYNC came, with its counter if it had one.
    pub(crate) fn sync<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
        counter: Option<u8>,
    ) {
        if !self.is_valid() {
            return;
        }
        if self.waits_for_start {
            match counter {
                Some(counter) if counter != self.config.sync_start => return,
                _ => self.waits_for_start = false,
            }
            // The SYNC that starts the count is the one that the first PDO follows.
            self.syncs = self.config.kind.saturating_sub(1);
        }
        match self.config.kind {
            kind::SYNC_RTR => {
                self.last = self.mapping.sample(objects, mapped);
                self.sampled = true;
            }
            kind::ACYCLIC => {
                let data = self.mapping.sample(objects, mapped);
                self.pending = data != self.last || !self.sampled;
            }
            _ if self.is_cyclic() => {
                self.syncs += 1;
                if self.syncs >= self.config.kind {
                    self.syncs = 0;
                    self.due(objects, mapped);
                }
            }
            _ => {}
        }
    }

    /// A cyclic transmission is due; the repeat counter may hold it back.
    fn due<D: Services>(&mut self, objects: &mut Objects<'_, D>, mapped: &[Mapped]) {
        if self.config.repeat != 0 {
            let data = self.mapping.sample(objects, mapped);
            if data != self.last {
                self.last = data;
                self.repeats_left = self.config.repeat;
            }
            if self.repeats_left == 0 {
                return;
            }
            self.repeats_left -= 1;
        }
        self.pending = true;
    }

    /// The event timer, if its tick has come.
    pub(crate) fn handle_timeout<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) {
        if self.event_at.is_due(objects.now) {
            self.event_at = self.event_at.next_period(self.config.event, objects.now);
            self.by_timer = !self.pending;
            self.due(objects, mapped);
        }
    }

    /// Returns whether it is sent when a mapped value changes, in a family that sends changes.
    pub(crate) fn watches_changes(&self) -> bool {
        self.is_valid() && self.is_event_driven()
    }

    /// Returns whether a mapped value changes without notifying the node.
    pub(crate) fn watches_live(&self) -> bool {
        self.watches_changes() && self.mapping.is_live()
    }

    /// Marks it as pending if a mapped value has changed that it is sent for.
    pub(crate) fn notice_change<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) {
        if self.watches_changes() && !self.pending {
            let data = self.mapping.sample(objects, mapped);
            self.pending =
                data != self.last && self.mapping.is_event(objects, mapped, self.last, data);
        }
    }

    /// The next tick of its event timer.
    pub(crate) fn deadline(&self) -> Deadline {
        self.event_at
    }

    /// Time when what is pending can be sent.
    pub(crate) fn ready_at(&self) -> Deadline {
        if self.pending {
            Deadline::at(self.inhibited_until)
        } else {
            Deadline::NEVER
        }
    }

    /// The frame, with the current values. Call it when the TPDO [is ready](Self::is_ready).
    pub(crate) fn send<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) -> Frame {
        let data = self.mapping.sample(objects, mapped);
        self.pending = false;
        self.last = data;
        self.sampled = true;
        if self.config.kind >= kind::RTR {
            let inhibit = u64::from(self.config.inhibit) * 100;
            self.inhibited_until = objects.now.plus_micros(inhibit);
        }
        // CiA 301, chapter 7.2.2.3: the timer elapses where no event has occurred. What the timer itself sends
        // does not shift it, also if the host is late.
        let by_timer = core::mem::take(&mut self.by_timer);
        let starts_anew = objects.profile.pdo.event_timer == EventTimer::SinceTransmission;
        if starts_anew && !by_timer && self.event_at.is_set() {
            self.event_at = Deadline::at(objects.now.plus_millis(self.config.event.into()));
        }
        self.frame(data)
    }

    /// Returns whether it waits to be sent, now or later.
    pub(crate) fn is_pending(&self) -> bool {
        self.pending
    }

    /// Returns whether it waits to be sent, and no inhibit time holds it back.
    pub(crate) fn is_ready(&self, now: Instant) -> bool {
        self.pending && now >= self.inhibited_until
    }

    fn frame(&self, data: [u8; 8]) -> Frame {
        Frame::padded(self.config.id, data, self.mapping.len())
    }
}
