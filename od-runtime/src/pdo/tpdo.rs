//! One TPDO: when it is sent, and with what.

use super::config::{Config, Parameters, Validity, kind};
use super::fixed::{Fixed, is_fixed};
use super::mapping::Mapping;
use crate::application::{Application, Context};
use crate::deadline::Deadline;
use crate::device::Device;
use crate::objects::Objects;
use crate::rooms::Rooms;
use crate::store::Store;
use od_model::Dictionary;
use od_wire::{CanId, Frame, Instant, NodeId};

/// TPDO: its configuration and its state.
#[derive(Clone, Debug)]
pub(crate) struct Tpdo<R: Rooms> {
    config: Config,
    mapping: Mapping<R>,
    /// The next tick of the event timer.
    event_at: Deadline,
    inhibited_until: Instant,
    /// To be sent as soon as the inhibit time allows.
    pending: bool,
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

impl<R: Rooms> Tpdo<R> {
    /// One that does not exist.
    pub(crate) const NONE: Self = Self {
        config: Config::NONE,
        mapping: Mapping::NONE,
        event_at: Deadline::NEVER,
        inhibited_until: Instant::ZERO,
        pending: false,
        syncs: 0,
        waits_for_start: false,
        repeats_left: 0,
        last: [0; 8],
        sampled: false,
    };

    /// Reads the objects of TPDO `number` (0 is 1800h and 1A00h) again. Answers whether they say something
    /// else than before; only then the TPDO restarts. `fixed` is its mapping where none can change;
    /// `is_taken` knows the CAN-IDs by which other services send.
    pub(crate) fn configure<D: Device>(
        &mut self,
        objects: &Objects<'_, D>,
        number: u16,
        fixed: &Fixed,
        is_taken: &dyn Fn(CanId) -> bool,
    ) -> bool {
        let mut config = Config::load(objects, number, is_taken);
        let mut changed = match const { is_fixed::<D>() } {
            true => self.mapping.fix(objects, 0x1A00 + number, fixed),
            false => self.mapping.load(objects, 0x1A00 + number),
        };
        if self.mapping.len() == 0 {
            config.validity = Validity::Off;
        }
        changed |= !config.is_same(&self.config);
        if changed {
            self.config = config;
            self.stop();
            self.inhibited_until = Instant::ZERO;
            self.syncs = 0;
            self.waits_for_start = false;
            self.repeats_left = 0;
            self.last = [0; 8];
            self.sampled = false;
        }
        changed
    }

    #[inline(always)]
    fn is_valid(&self) -> bool {
        self.config.validity > Validity::Refused
    }

    /// Whether its objects make it valid, and its CAN-ID does not.
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
    pub(crate) fn start<D: Device>(&mut self, objects: &mut Objects<'_, D>) {
        self.syncs = 0;
        self.pending = false;
        self.repeats_left = self.config.repeat;
        self.waits_for_start = self.config.sync_start != 0;
        self.sampled = false;
        self.inhibited_until = objects.now;
        self.event_at = Deadline::NEVER;
        if D::TIMED && self.is_valid() && self.is_event_driven() && self.config.event > 0 {
            self.event_at = Deadline::at(objects.now.plus_millis(self.config.event.into()));
        }
        if self.is_valid() {
            self.last = self.mapping.sample(objects);
        }
    }

    /// Operational begins: a family that sends changes says first what there is to change.
    pub(crate) fn announce<D: Device>(&mut self, objects: &Objects<'_, D>) {
        let sends_changes = objects.profile().pdo.event_on_change;
        self.pending |= sends_changes && self.is_valid() && self.is_event_driven();
    }

    /// Operational ends.
    pub(crate) fn stop(&mut self) {
        self.event_at = Deadline::NEVER;
        self.pending = false;
    }

    /// Whether a remote frame with this CAN-ID requests it.
    pub(crate) fn answers(&self, id: CanId) -> bool {
        self.requested_by() == Some(id)
    }

    /// CAN-ID of the remote frame that requests it.
    pub(crate) fn requested_by(&self) -> Option<CanId> {
        (self.config.validity == Validity::Requested).then_some(self.config.id)
    }

    /// A remote frame asks for it: synchronous types answer with what the last SYNC saw.
    pub(crate) fn request<D: Device>(&mut self, objects: &mut Objects<'_, D>) -> Option<Frame> {
        if self.config.kind <= kind::SYNC_RTR {
            if !self.sampled {
                self.last = self.mapping.sample(objects);
            }
            return Some(self.frame(self.last));
        }
        self.pending = true;
        None
    }

    /// Whether a SYNC is only [counted](Self::count_sync).
    #[inline(always)]
    pub(crate) fn only_counts<D: Device>(&self) -> bool {
        match self.config.kind {
            _ if !self.is_valid() => true,
            kind::ACYCLIC | kind::SYNC_RTR => false,
            _ => !(D::REPEATED && self.config.repeat != 0 || D::STARTED && self.waits_for_start),
        }
    }

    /// The number of SYNCs that it is sent after; 0 where it does not count them.
    pub(crate) fn cycle(&self) -> u8 {
        match self.is_valid() && self.is_cyclic() {
            true => self.config.kind,
            false => 0,
        }
    }

    /// To be sent, if it is marked.
    pub(crate) fn pend_if(&mut self, is_marked: bool) {
        self.pending |= is_marked;
    }

    /// SYNC came. Returns whether the PDO is due.
    #[inline(always)]
    pub(crate) fn count_sync(&mut self) -> bool {
        if self.is_valid() && self.is_cyclic() {
            self.syncs += 1;
            if self.syncs >= self.config.kind {
                self.syncs = 0;
                self.pending = true;
            }
        }
        self.pending
    }

    /// SYNC came, with its counter if it had one.
    pub(crate) fn sync<D: Device>(&mut self, objects: &mut Objects<'_, D>, counter: Option<u8>) {
        if !self.is_valid() {
            return;
        }
        if D::STARTED && self.waits_for_start {
            match counter {
                Some(counter) if counter != self.config.sync_start => return,
                _ => self.waits_for_start = false,
            }
            // The SYNC that starts the count is the one the first PDO follows.
            self.syncs = self.config.kind.saturating_sub(1);
        }
        match self.config.kind {
            kind::SYNC_RTR => {
                self.last = self.mapping.sample(objects);
                self.sampled = true;
            }
            kind::ACYCLIC => {
                let data = self.mapping.sample(objects);
                self.pending = data != self.last || !self.sampled;
            }
            _ if self.is_cyclic() => {
                self.syncs += 1;
                if self.syncs >= self.config.kind {
                    self.syncs = 0;
                    self.due(objects);
                }
            }
            _ => {}
        }
    }

    /// A cyclic transmission is due; the repeat counter may hold it back.
    #[inline]
    fn due<D: Device>(&mut self, objects: &mut Objects<'_, D>) {
        if D::REPEATED && self.config.repeat != 0 {
            let data = self.mapping.sample(objects);
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
    #[inline]
    pub(crate) fn handle_timeout<D: Device>(&mut self, objects: &mut Objects<'_, D>) {
        if D::TIMED && self.event_at.is_due(objects.now) {
            self.event_at = self.event_at.next_period(self.config.event, objects.now);
            self.due(objects);
        }
    }

    /// Whether all that the event timer does is to [tick](Self::tick).
    #[inline(always)]
    pub(crate) fn only_ticks<D: Device>(&self) -> bool {
        !(D::REPEATED && self.config.repeat != 0)
    }

    /// Whether the tick of the event timer has come.
    #[inline(always)]
    pub(crate) fn is_due(&self, now: Instant) -> bool {
        self.event_at.is_due(now)
    }

    /// The event timer ticks, and [that is all](Self::only_ticks). Returns whether the PDO waits now; if not,
    /// it can be sent at once, and is to be marked.
    #[inline(always)]
    pub(crate) fn tick(&mut self, now: Instant) -> bool {
        self.event_at = self.event_at.next_of(self.config.event, now);
        self.pending |= self.inhibited_until > now;
        self.pending
    }

    /// Whether it is sent when a mapped value changes, in a family that sends changes.
    pub(crate) fn watches_changes(&self) -> bool {
        self.is_valid() && self.is_event_driven()
    }

    /// Whether a mapped value changes without a word to the node.
    pub(crate) fn watches_live(&self) -> bool {
        self.watches_changes() && self.mapping.is_live()
    }

    /// Marks it as pending if a mapped value has changed that it is sent for.
    pub(crate) fn notice_change<D: Device>(&mut self, objects: &mut Objects<'_, D>) {
        if self.watches_changes() && !self.pending {
            self.pending = self.mapping.sample(objects) != self.last;
        }
    }

    /// The next tick of its event timer.
    #[inline]
    pub(crate) fn deadline<D: Device>(&self) -> Deadline {
        if !D::TIMED {
            return Deadline::NEVER;
        }
        self.event_at
    }

    /// Time when what is pending can be sent; so is what SYNC marked.
    pub(crate) fn ready_at(&self, is_marked: bool) -> Deadline {
        match self.pending || is_marked {
            true => Deadline::at(self.inhibited_until),
            false => Deadline::NEVER,
        }
    }

    /// Whether the application has to bring a value up to date before it is sent.
    #[inline(always)]
    pub(crate) fn is_live(&self) -> bool {
        self.mapping.is_live()
    }

    /// Has the application bring the live values up to date, by the set of them.
    pub(crate) fn refresh<D: Device>(
        &self,
        application: &mut dyn Application,
        context: &mut Context<'_, '_>,
        live: u32,
    ) {
        self.mapping.refresh::<D>(application, context, live);
    }

    /// Whether all its values are plain numbers of the store, whether live or not.
    #[inline(always)]
    pub(crate) fn is_plain(&self) -> bool {
        self.mapping.is_plain()
    }

    /// The frame, with the values of the store. It is to be [ready](Self::is_ready).
    #[inline(always)]
    pub(crate) fn send<D: Device>(
        &mut self,
        dictionary: &Dictionary<'_>,
        values: &mut [u8],
        node_id: NodeId,
        now: Instant,
    ) -> Option<Frame> {
        let plain = self.is_plain().then(|| self.mapping.gather(values));
        let data = match plain.flatten() {
            Some(data) => data.to_le_bytes(),
            None => {
                let store = Store::new(dictionary, values, node_id).ok()?;
                self.mapping.read::<D>(&store)
            }
        };
        Some(self.sent::<D>(data, now))
    }

    /// As [`send`](Self::send), of one that [is plain](Self::is_plain) and has a single value; `None` if it has
    /// more, or if the value is one of the last of the store.
    #[inline(always)]
    pub(crate) fn send_single<D: Device>(&mut self, values: &[u8], now: Instant) -> Option<Frame> {
        let data = self.mapping.single(values)?;
        Some(self.sent::<D>(data.to_le_bytes(), now))
    }

    /// Puts the live values of one that [is plain](Self::is_plain) into the store; `None` if the application
    /// does not have all of them at hand.
    #[inline(always)]
    pub(crate) fn fetch_live(
        &self,
        application: &mut dyn Application,
        values: &mut [u8],
        now: Instant,
    ) -> Option<()> {
        self.mapping.fetch_live(application, values, now)
    }

    /// It is sent with these values.
    #[inline(always)]
    fn sent<D: Device>(&mut self, data: [u8; 8], now: Instant) -> Frame {
        self.pending = false;
        self.last = data;
        self.sampled = true;
        if self.config.kind >= kind::RTR {
            self.inhibited_until = match D::INHIBITED {
                true => now.plus_micros(u64::from(self.config.inhibit) * 100),
                false => now,
            };
        }
        self.frame(data)
    }

    /// Something waits to be sent, now or later.
    pub(crate) fn is_pending(&self) -> bool {
        self.pending
    }

    /// Something waits to be sent, and nothing keeps it.
    #[inline]
    pub(crate) fn is_ready<D: Device>(&self, now: Instant) -> bool {
        self.pending && (!D::INHIBITED || now >= self.inhibited_until)
    }

    fn frame(&self, data: [u8; 8]) -> Frame {
        Frame::padded(self.config.id, data, self.mapping.len())
    }

    /// Holds it back until then.
    #[cfg(test)]
    pub(crate) fn inhibit(&mut self, until: Instant) {
        self.inhibited_until = until;
    }
}
