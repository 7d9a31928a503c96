//! One TPDO: its configuration, and when it is sent (CiA 301, chapter 7.2.2.3, objects 1800h to
//! 1BFFh).

use super::mapping::{Mapped, Mapping};
use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::objects::Objects;
use crate::profile::EventTimer;
use crate::services::Services;
use od_model::TransmissionType;
use od_wire::{CanId, CobId, Frame, Instant};

/// Whether a TPDO is sent.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Validity {
    /// Never.
    Off,
    /// Never, although bit 31 is 0: no service may have the CAN-ID, or another service sends with
    /// it.
    Refused,
    On,
    /// Also when a remote frame requests it.
    Requested,
}

/// Configuration of a TPDO, from its communication parameter.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Config {
    validity: Validity,
    kind: TransmissionType,
    repeat: u8,
    sync_start: u8,
    id: CanId,
    /// Event timer in milliseconds.
    event: u32,
    /// Inhibit time in units of 100 µs.
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
    /// It is sent as soon as the inhibit time allows.
    pending: bool,
    /// It is pending only because of the event timer.
    by_timer: bool,
    /// Number of SYNCs since the last transmission.
    syncs: u8,
    /// It waits for the SYNC whose counter is `sync_start`.
    waits_for_start: bool,
    /// Number of transmissions of this value that the repeat counter still allows.
    repeats_left: u8,
    /// Data that was sampled or sent last.
    last: [u8; 8],
    sampled: bool,
}

impl Blank for Tpdo {
    const BLANK: Self = Self {
        config: Config {
            validity: Validity::Off,
            kind: TransmissionType::new(0),
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
    /// Reads the communication parameter of TPDO `number`. `is_taken` returns whether another
    /// service sends with a CAN-ID.
    fn load<D: Services>(
        objects: &Objects<'_, D>,
        number: u16,
        is_taken: &dyn Fn(CanId) -> bool,
    ) -> Self {
        let profile = &objects.profile.pdo;
        let word = |index, sub| objects.store.word(index, sub, 0);
        let parameter = 0x1800 + number;
        let cob_id = CobId::new(objects.store.word(parameter, 1, 1 << 31));
        let kind = TransmissionType::new(word(parameter, 2) as u8);
        let is_sync_only = profile
            .sync_only
            .is_some_and(|(index, bits)| word(index, 0) & bits == bits);
        let is_allowed = kind.is_synchronous() || !is_sync_only;
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
    /// Reads the objects of TPDO `number` (0 is 1800h and 1A00h) again; its mapping entries are in
    /// `mapped` from `first` on. `is_taken` returns whether another service sends with a CAN-ID.
    /// Returns whether the configuration has changed; only then the TPDO restarts.
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

    /// Returns whether the object is valid but its CAN-ID is refused.
    pub(crate) fn is_refused(&self) -> bool {
        self.config.validity == Validity::Refused
    }

    /// CAN-ID of its frames, while it is valid.
    pub(crate) fn sent_by(&self) -> Option<CanId> {
        self.is_valid().then_some(self.config.id)
    }

    /// Starts in Operational, with the first period of the event timer and the first SYNC.
    pub(crate) fn start<D: Services>(&mut self, objects: &mut Objects<'_, D>, mapped: &[Mapped]) {
        self.syncs = 0;
        self.pending = false;
        self.repeats_left = self.config.repeat;
        self.waits_for_start = self.config.sync_start != 0;
        self.sampled = false;
        self.inhibited_until = objects.now;
        self.event_at = Deadline::NEVER;
        if self.is_valid() && self.config.kind.is_event_driven() && self.config.event > 0 {
            self.event_at = Deadline::at(objects.now.plus_millis(self.config.event.into()));
        }
        if self.is_valid() {
            self.last = self.mapping.sample(objects, mapped);
        }
    }

    /// Sends the first values when Operational begins, in a family that sends changes.
    pub(crate) fn announce<D: Services>(&mut self, objects: &Objects<'_, D>) {
        let sends_changes = objects.profile.pdo.event_on_change;
        self.pending |= sends_changes && self.is_valid() && self.config.kind.is_event_driven();
    }

    /// Stops at the end of Operational.
    pub(crate) fn stop(&mut self) {
        self.event_at = Deadline::NEVER;
        self.pending = false;
    }

    /// CAN-ID of the remote frame that requests it.
    pub(crate) fn requested_by(&self) -> Option<CanId> {
        (self.config.validity == Validity::Requested).then_some(self.config.id)
    }

    /// Handles a remote frame that requests it. A synchronous TPDO responds with the values of the
    /// last SYNC.
    pub(crate) fn request<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) -> Option<Frame> {
        if self.config.kind.is_sampled_at_sync() {
            if !self.sampled {
                self.last = self.mapping.sample(objects, mapped);
            }
            return Some(self.frame(self.last));
        }
        self.pending = true;
        None
    }

    /// Handles SYNC, with its counter if it has one.
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
            // The SYNC that starts the count also triggers the first PDO.
            self.syncs = self.config.kind.raw().saturating_sub(1);
        }
        let kind = self.config.kind;
        if kind.is_acyclic() {
            let data = self.mapping.sample(objects, mapped);
            self.pending = data != self.last || !self.sampled;
        } else if let Some(cycle) = kind.cycle() {
            self.syncs += 1;
            if self.syncs >= cycle {
                self.syncs = 0;
                self.mark_due(objects, mapped);
            }
        } else if kind.is_rtr_only() && kind.is_sampled_at_sync() {
            self.last = self.mapping.sample(objects, mapped);
            self.sampled = true;
        }
    }

    /// Marks a cyclic transmission as pending, unless the repeat counter forbids it.
    fn mark_due<D: Services>(&mut self, objects: &mut Objects<'_, D>, mapped: &[Mapped]) {
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

    /// Handles the event timer, if its tick is due.
    pub(crate) fn handle_timeout<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) {
        if self.event_at.is_due(objects.now) {
            self.event_at = self.event_at.next_period(self.config.event, objects.now);
            self.by_timer = !self.pending;
            self.mark_due(objects, mapped);
        }
    }

    /// Returns whether a change of a mapped value sends it, in a family that sends changes.
    pub(crate) fn watches_changes(&self) -> bool {
        self.is_valid() && self.config.kind.is_event_driven()
    }

    /// Returns whether a mapped value may change without notifying the node.
    pub(crate) fn watches_live(&self) -> bool {
        self.watches_changes() && self.mapping.is_live()
    }

    /// Marks it as pending if a mapped value has changed and the change is an event.
    pub(crate) fn notice_change<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) {
        if self.watches_changes() && !self.pending {
            let data = self.mapping.sample(objects, mapped);
            self.pending =
                data != self.last && self.mapping.compare(objects, mapped, &mut self.last, data);
        }
    }

    /// Time of the next tick of its event timer.
    pub(crate) fn deadline(&self) -> Deadline {
        self.event_at
    }

    /// Time when the pending transmission can be sent.
    pub(crate) fn ready_at(&self) -> Deadline {
        if self.pending {
            Deadline::at(self.inhibited_until)
        } else {
            Deadline::NEVER
        }
    }

    /// Returns the frame with the current values. Call it when the TPDO [is ready](Self::is_ready).
    pub(crate) fn send<D: Services>(
        &mut self,
        objects: &mut Objects<'_, D>,
        mapped: &[Mapped],
    ) -> Frame {
        let data = self.mapping.sample(objects, mapped);
        self.pending = false;
        self.last = data;
        self.sampled = true;
        if !self.config.kind.is_sampled_at_sync() {
            let inhibit = u64::from(self.config.inhibit) * 100;
            self.inhibited_until = objects.now.plus_micros(inhibit);
        }
        // CiA 301, chapter 7.2.2.3: the event timer elapses if no event has occurred. A
        // transmission that the timer itself caused does not shift its grid, even if the host is
        // late.
        let by_timer = core::mem::take(&mut self.by_timer);
        let restarts = objects.profile.pdo.event_timer == EventTimer::SinceTransmission;
        if restarts && !by_timer && self.event_at.is_set() {
            self.event_at = Deadline::at(objects.now.plus_millis(self.config.event.into()));
        }
        self.frame(data)
    }

    /// Returns whether it is pending, now or after the inhibit time.
    pub(crate) fn is_pending(&self) -> bool {
        self.pending
    }

    /// Returns whether it is pending and the inhibit time is over.
    pub(crate) fn is_ready(&self, now: Instant) -> bool {
        self.pending && now >= self.inhibited_until
    }

    fn frame(&self, data: [u8; 8]) -> Frame {
        Frame::padded(self.config.id, data, self.mapping.len())
    }
}
