//! The node: the only module that knows all services.
//!
//! ```text
//! power_on ─┐                       ┌─> poll_transmit   frames
//! handle_frame ──> services ──────> ├─> poll_timeout    next deadline
//! handle_timeout ┘                  └─> poll_event      what happened
//! ```
//! Drain `poll_transmit` after every input, then sleep until `poll_timeout` or the next
//! frame. Everything is a function of the inputs and their order; nothing else.

mod boot;
mod bus;
mod errors;
mod event;
mod input;

use crate::fifo::Fifo;
use crate::objects::{Device, Objects, Outbox};
use crate::store::StoreTooSmall;
use crate::{emcy, error_control, lss, pdo, sdo};
use od_wire::nmt::State;
use od_wire::{CanId, Frame, Instant, NodeId};

pub use bus::BusEvent;
pub use event::Event;

/// A CANopen slave.
///
/// `PDO`: how many TPDOs and RPDOs it can have. `SDO`: bytes of the transfer buffer, the
/// longest value that a segmented or block transfer can carry. It has no lifetime: what
/// belongs to the device is passed to each call.
#[derive(Debug)]
pub struct Node<const PDO: usize = 4, const SDO: usize = 128> {
    core: Core<PDO, SDO>,
    /// Filled while a call has the device, emptied before it returns.
    outbox: Outbox,
}

/// The node without its outbox, so that the device of a call can hold that.
#[derive(Debug)]
struct Core<const PDO: usize, const SDO: usize> {
    node_id: NodeId,
    state: State,
    powered: bool,
    now: Instant,
    /// Boot-up is due then; only while initialising.
    boot_at: Option<Instant>,
    tick_at: Option<Instant>,
    sync_id: CanId,
    out: Fifo<Frame, 8>,
    /// The frame before those of `out`, if it is an SDO answer: its data as one word. Most
    /// frames are, and this way they do not go through memory in pieces.
    answer: Option<u64>,
    events: Fifo<Event, 16>,
    sdo: sdo::Server<SDO>,
    heartbeat: error_control::Producer,
    monitor: error_control::Monitor,
    lss: lss::Slave,
    /// Nothing is sent or received: LSS activates a bit rate, or the CAN controller is bus-off.
    mute: Option<bus::Mute>,
    /// What the CAN controller said last; overruns aside.
    bus: BusEvent,
    /// The error behaviour wants a reset when the call is over.
    reset_due: bool,
    /// Somebody was lost in this call, and 1029h:01 has not acted on it yet.
    lost: bool,
    /// A save is complete then.
    save_at: Option<Instant>,
    emcy: emcy::Producer,
    tpdo: [pdo::Tpdo; PDO],
    tpdo_count: usize,
    rpdo: [pdo::Rpdo; PDO],
    rpdo_count: usize,
    /// There is a TPDO that is sent when a mapped value changes.
    watches_changes: bool,
    /// A TPDO may be waiting to be sent.
    pdo_pending: bool,
}

impl<const PDO: usize, const SDO: usize> Node<PDO, SDO> {
    /// A node without power, with the ID that it starts with unless the application or
    /// storage knows another.
    pub const fn new(node_id: NodeId) -> Self {
        Self {
            core: Core::new(node_id),
            outbox: Outbox::new(),
        }
    }

    /// The NMT state.
    pub const fn state(&self) -> State {
        self.core.state
    }

    /// Is there power?
    pub const fn is_powered(&self) -> bool {
        self.core.powered
    }

    /// The active node ID.
    pub const fn node_id(&self) -> NodeId {
        self.core.node_id
    }

    /// Power comes: values are taken from storage or their defaults, and the node boots up.
    ///
    /// # Errors
    /// [`StoreTooSmall`] where `device.values` does not hold the dictionary's values; the
    /// node stays without power.
    pub fn power_on(&mut self, device: &mut Device<'_>, now: Instant) -> Result<(), StoreTooSmall> {
        self.core.power_on(device, &mut self.outbox, now)
    }

    /// Power goes: silence until [`power_on`](Self::power_on).
    pub fn power_off(&mut self) {
        self.core.power_off(&mut self.outbox);
    }

    /// A frame was received.
    #[inline]
    pub fn handle_frame(&mut self, device: &mut Device<'_>, now: Instant, frame: &Frame) {
        self.core.handle_frame(device, &mut self.outbox, now, frame);
    }

    /// Time has passed.
    #[inline]
    pub fn handle_timeout(&mut self, device: &mut Device<'_>, now: Instant) {
        self.core.handle_timeout(device, &mut self.outbox, now);
    }

    /// The world outside the bus changed (shaft, faults, switches): the application ticks.
    pub fn handle_change(&mut self, device: &mut Device<'_>, now: Instant) {
        self.core.handle_change(device, &mut self.outbox, now);
    }

    /// The CAN controller changed its state, or lost frames. What is not told is not known:
    /// a host that never calls this has a bus without errors.
    pub fn handle_bus(&mut self, device: &mut Device<'_>, now: Instant, event: BusEvent) {
        self.core.handle_bus(device, &mut self.outbox, now, event);
    }

    /// Is the CAN controller bus-off, as far as the node was told? It neither sends nor
    /// receives then.
    pub const fn is_bus_off(&self) -> bool {
        self.core.is_bus_off()
    }

    /// The next frame to send; `None` when all are out. `now` is the moment of the input
    /// before it.
    #[inline]
    pub fn poll_transmit(&mut self, device: &mut Device<'_>, now: Instant) -> Option<Frame> {
        self.core.poll_transmit(device, &mut self.outbox, now)
    }

    /// When [`handle_timeout`](Self::handle_timeout) wants to be called, if at all.
    #[inline]
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.core.poll_timeout()
    }

    /// What happened since the last call, oldest first. Events that nobody takes are
    /// dropped when sixteen wait.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.core.events.pop()
    }
}

impl<const PDO: usize, const SDO: usize> Core<PDO, SDO> {
    const fn new(node_id: NodeId) -> Self {
        Self {
            node_id,
            state: State::Initialising,
            powered: false,
            now: Instant::ZERO,
            boot_at: None,
            tick_at: None,
            sync_id: CanId::standard(0x80),
            out: Fifo::new(Frame::standard(0, &[])),
            answer: None,
            events: Fifo::new(Event::StorageDamaged),
            sdo: sdo::Server::new(),
            heartbeat: error_control::Producer::new(),
            monitor: error_control::Monitor::new(),
            lss: lss::Slave::new(),
            mute: None,
            bus: BusEvent::Active,
            reset_due: false,
            lost: false,
            save_at: None,
            emcy: emcy::Producer::new(),
            tpdo: [pdo::Tpdo::NONE; PDO],
            tpdo_count: 0,
            rpdo: [pdo::Rpdo::NONE; PDO],
            rpdo_count: 0,
            watches_changes: false,
            pdo_pending: false,
        }
    }

    #[inline]
    fn poll_transmit(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) -> Option<Frame> {
        if self.mute.is_some() {
            self.discard_frames();
            return None;
        }
        if let Some(answer) = self.answer.take() {
            return Some(Frame::full(self.node_id.plus(0x580), answer.to_le_bytes()));
        }
        if let Some(frame) = self.out.pop() {
            return Some(frame);
        }
        if self.pdo_pending || self.emcy.deadline().is_some() || self.sdo.is_sending() {
            return self.poll_services(device, outbox, now);
        }
        None
    }

    /// Sends an SDO answer, after all that waits already.
    #[inline]
    fn answer(&mut self, answer: [u8; 8]) {
        if self.answer.is_none() && self.out.is_empty() {
            self.answer = Some(u64::from_le_bytes(answer));
        } else {
            self.out.push(Frame::full(self.node_id.plus(0x580), answer));
        }
    }

    /// What was to be sent is not.
    fn discard_frames(&mut self) {
        self.out.clear();
        self.answer = None;
    }

    /// What services have to send that waits for nobody's request.
    #[inline(never)]
    fn poll_services(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) -> Option<Frame> {
        if self.pdo_pending {
            let frame = self.poll_pdo(device, outbox, now);
            if frame.is_some() {
                return frame;
            }
        }
        if self.emcy.deadline().is_some() {
            let frame = self.poll_emcy(device, outbox, now);
            if frame.is_some() {
                return frame;
            }
        }
        let segment = self.sdo.poll()?;
        Some(Frame::full(self.node_id.plus(0x580), segment))
    }

    fn poll_pdo(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) -> Option<Frame> {
        let mut objects = device.objects(self.node_id, now.max(self.now), outbox)?;
        let pdos = self.tpdo.get_mut(..self.tpdo_count).unwrap_or_default();
        let frame = pdos.iter_mut().find_map(|pdo| pdo.poll(&mut objects));
        self.pdo_pending = pdos.iter().any(|pdo| pdo.is_ready(objects.now));
        frame
    }

    #[cold]
    fn poll_emcy(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) -> Option<Frame> {
        if !self.sends_emcy() {
            return None;
        }
        let objects = device.objects(self.node_id, now.max(self.now), outbox)?;
        self.emcy.poll(&objects.store, objects.now)
    }

    /// EMCYs wait for the boot-up message, and for the end of Stopped.
    fn sends_emcy(&self) -> bool {
        matches!(self.state, State::PreOperational | State::Operational) && self.mute.is_none()
    }

    fn poll_timeout(&self) -> Option<Instant> {
        if !self.powered {
            return None;
        }
        let mut next = None;
        let mut consider = |at: Option<Instant>| {
            next = match (next, at) {
                (Some(next), Some(at)) => Some(at.min(next)),
                (next, at) => next.or(at),
            }
        };
        consider(self.boot_at);
        consider(self.tick_at);
        consider(self.heartbeat.deadline());
        consider(self.monitor.deadline());
        consider(self.mute.map(|mute| mute.until));
        consider(self.sdo.deadline());
        consider(self.save_at);
        if self.sends_emcy() {
            consider(self.emcy.deadline());
        }
        if self.state == State::Operational && self.mute.is_none() {
            for pdo in self.tpdo.get(..self.tpdo_count).unwrap_or_default() {
                consider(pdo.deadline());
            }
        }
        // A host that came to the end of time would be called back there for ever.
        next.filter(|at| *at < Instant::MAX)
    }

    fn enter(&mut self, objects: &mut Objects<'_>, state: State) {
        if self.state == state {
            return;
        }
        if self.state == State::Stopped && objects.profile.lss.is_some_and(|lss| lss.stopped_only) {
            self.lss.leave();
        }
        self.state = state;
        self.events.push(Event::State(state));
        match state {
            State::Operational => self.start_pdos(objects),
            _ => self.stop_pdos(),
        }
        if state == State::Stopped {
            self.sdo.forget();
        }
    }

    fn start_pdos(&mut self, objects: &mut Objects<'_>) {
        for pdo in self.tpdo.get_mut(..self.tpdo_count).unwrap_or_default() {
            pdo.start(objects);
            pdo.announce(objects);
            self.pdo_pending |= pdo.is_pending();
        }
    }

    fn stop_pdos(&mut self) {
        for pdo in self.tpdo.get_mut(..self.tpdo_count).unwrap_or_default() {
            pdo.stop();
        }
        for pdo in self.rpdo.get_mut(..self.rpdo_count).unwrap_or_default() {
            pdo.stop();
        }
        self.pdo_pending = false;
    }
}
