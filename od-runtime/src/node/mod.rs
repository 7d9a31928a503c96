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
mod clocks;
mod controller;
mod ear;
mod effects;
mod errors;
mod event;
mod fits;
mod input;
mod listen;
mod output;
mod own;
mod pending;
mod quick;
mod servers;
mod ticks;
mod wanted;

use od_wire::nmt::State;
use od_wire::{CanId, Frame, Instant, NodeId};

use crate::change::Change;
use crate::deadline::Deadline;
use crate::device::{AnyDevice, Device};
use crate::extras::Extras;
use crate::fifo::Fifo;
use crate::lent::Lent;
use crate::objects::Objects;
use crate::objects::command::Saving;
use crate::objects::outbox::Outbox;
use crate::rooms::{Room, Rooms};
use crate::{emcy, error_control, lss, pdo, sdo};

pub use controller::BusEvent;
pub use event::Event;
pub use fits::Unfit;

/// A CANopen slave.
///
/// `PDO` is the number of TPDOs and of RPDOs that it can have, `SDO` the bytes of the transfer
/// buffer: the longest value that a segmented or block transfer can carry, or the longest part of a
/// streamed one ([`Application::stream`](crate::Application::stream)). `D` says what the
/// compiler knows of the device: with `object_dictionary!` the type `Node` of its module has the
/// sizes of the dictionary, and other sizes do not compile unless they fit. `X` is the room for
/// services that few devices have ([`Extras`]).
///
/// The node has no lifetime: each call borrows the device as a [`Lent`].
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Node<D = AnyDevice, const PDO: usize = 4, const SDO: usize = 128, X: Extras<D, SDO> = ()>
{
    machines: Machines<D, PDO, SDO, X>,
    /// [`Objects`] holds both while a call has the device, so they are not among the machines.
    outbox: Outbox<<X::Rooms as Rooms>::Changes<Change>>,
    saves: <X::Rooms as Rooms>::Saves<Saving>,
}

/// The state of the node: NMT, queues, and one machine for each service.
#[derive(Clone, Debug)]
#[repr(C)] // What is small and used everywhere comes first: a Cortex-M reaches it by short instructions.
struct Machines<D, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> {
    state: State,
    powered: bool,
    /// Kinds of frames that may wait to be sent, in the bits of [`pending`].
    pending: u8,
    node_id: NodeId,
    /// The node ID is FFh (CiA 305), and only LSS works. Not `configured`: a node without power is
    /// all zeros, so that a static one takes no flash.
    unconfigured: bool,
    /// The error behaviour requests a reset when the call is over.
    reset_due: bool,
    /// Heartbeat or guarding failed in this call, and 1029h:01 has not acted on it yet.
    lost: bool,
    /// There is a TPDO that is sent when a mapped value changes.
    watches_changes: bool,
    /// Such a value may change without a word to the node.
    watches_live: bool,
    /// The CAN-IDs that the node listens to may be others than those that the host knows.
    wanted_changed: bool,
    /// CAN-IDs of SYNC, EMCY and TIME that were refused.
    refused: u8,
    /// Last report of the CAN controller, except overruns.
    bus: BusEvent,
    /// Node ID of the first start, where the image keeps it ([`LssProfile::is_own`](crate::LssProfile::is_own)).
    made_with: NodeId,
    /// It was made without a node ID.
    made_unconfigured: bool,
    quick: ear::Quick,
    tpdo_count: u16,
    rpdo_count: u16,
    ear: ear::Ear,
    now: Instant,
    /// The first of all deadlines but those of frames that wait; [`Instant::ZERO`]: not known, and
    /// [`Instant::MAX`]: never.
    next: Instant,
    /// Boot-up is due then; only while initialising.
    boot_at: Deadline,
    tick_at: Deadline,
    /// A save is complete then.
    save_at: <X::Rooms as Rooms>::Saves<Deadline>,
    heartbeat: error_control::Producer,
    /// Nothing is sent or received: LSS activates a bit rate, or the CAN controller is bus-off.
    mute: Option<controller::Mute>,
    /// `None`: 1005h has a CAN-ID that no service may have.
    sync_id: Option<CanId>,
    /// The frame before those of `out`, if it is an SDO response: its data as words. Most
    /// frames are, and this way they do not go through memory in pieces.
    answer: [u32; 2],
    sdo: sdo::Server<D, SDO, X::Rooms>,
    emcy: emcy::Producer<X::Rooms>,
    monitor: error_control::Monitor<X::Rooms>,
    lss: <X::Rooms as Rooms>::Lss<lss::Slave>,
    out: Fifo<<X::Rooms as Rooms>::Frames<Frame>>,
    events: Fifo<<X::Rooms as Rooms>::Events<Event>>,
    tpdo: [pdo::Tpdo<X::Rooms>; PDO],
    rpdo: <X::Rooms as Rooms>::Rpdos<pdo::Rpdo<X::Rooms>, PDO>,
    extras: X,
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// A node without power. It starts with this node ID, unless the application or the saved
    /// values set another.
    ///
    /// Does not compile where [`fits`](Self::fits) refuses the dictionary of `D`.
    pub const fn new(node_id: NodeId) -> Self {
        Self::with_extras(node_id, X::NEW)
    }

    /// As [`new`](Self::new), with room for services that was made at run time.
    pub const fn with_extras(node_id: NodeId, extras: X) -> Self {
        const { Self::assert_fits() };
        Self {
            outbox: Outbox::new(Room::BLANK),
            saves: Room::BLANK,
            machines: Machines::new(node_id, extras),
        }
    }

    /// The NMT state.
    pub const fn state(&self) -> State {
        self.machines.state
    }

    /// Whether the node has power.
    pub const fn is_powered(&self) -> bool {
        self.machines.powered
    }

    /// The active node ID.
    pub const fn node_id(&self) -> NodeId {
        self.machines.node_id
    }

    /// Sets the node ID that a device of [`LssProfile::CIA305`](crate::LssProfile::CIA305) starts with
    /// from the next power-on while LSS has stored none. `None`: it is not configured, and there
    /// is nothing but LSS until a master gives it one.
    pub const fn set_node_id(&mut self, node_id: Option<NodeId>) {
        let node = &mut self.machines;
        node.made_unconfigured = node_id.is_none();
        if let Some(node_id) = node_id {
            node.made_with = node_id;
        }
        if !node.powered {
            node.unconfigured = node_id.is_none();
        }
    }

    /// Whether the node has a node ID; without one it does nothing but LSS.
    pub const fn is_configured(&self) -> bool {
        !self.machines.unconfigured
    }

    /// Whether the CAN controller is bus-off, as far as [`handle_bus`](Self::handle_bus)
    /// reported it. Until it ends the node neither sends nor receives.
    pub const fn is_bus_off(&self) -> bool {
        self.machines.is_bus_off()
    }

    /// The top of every call: the device taken apart, and the machines that work on it; `None`
    /// without power.
    ///
    /// Time does not run backwards here, whatever the host's clock says.
    #[inline(never)]
    fn open<'c>(
        &'c mut self,
        device: &'c mut Lent<'_>,
        now: Instant,
    ) -> Option<(&'c mut Machines<D, PDO, SDO, X>, Objects<'c, D>)> {
        let machines = &mut self.machines;
        if !machines.powered {
            return None;
        }
        machines.pend_marks();
        machines.now = machines.now.max(now);
        machines.next = Instant::ZERO;
        machines.pending |= pending::OTHER;
        let (outbox, saving) = (
            Room::outbox(&mut self.outbox),
            self.saves.all_mut().first_mut(),
        );
        let objects = device.objects(machines.node_id, machines.now, outbox, saving)?;
        Some((machines, objects))
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    const fn new(node_id: NodeId, extras: X) -> Self {
        Self {
            node_id,
            made_with: node_id,
            made_unconfigured: false,
            unconfigured: false,
            state: State::Initialising,
            powered: false,
            now: Instant::ZERO,
            boot_at: Deadline::NEVER,
            tick_at: Deadline::NEVER,
            next: Instant::ZERO,
            sync_id: None,
            ear: ear::Ear::DEAF,
            out: Fifo::new(Room::BLANK),
            answer: [0; 2],
            pending: 0,
            events: Fifo::new(Room::BLANK),
            sdo: sdo::Server::idle(),
            heartbeat: error_control::Producer::new(),
            monitor: error_control::Monitor::new(),
            lss: Room::BLANK,
            mute: None,
            bus: BusEvent::Active,
            reset_due: false,
            lost: false,
            save_at: Room::BLANK,
            emcy: emcy::Producer::new(),
            tpdo: [const { pdo::Tpdo::NONE }; PDO],
            tpdo_count: 0,
            rpdo: Room::BLANK,
            rpdo_count: 0,
            quick: ear::Quick::NONE,
            watches_changes: false,
            watches_live: false,
            wanted_changed: false,
            refused: 0,
            extras,
        }
    }

    /// RPDOs that there is room for.
    const RPDOS: usize =
        <<X::Rooms as Rooms>::Rpdos<pdo::Rpdo<X::Rooms>, PDO> as Room<pdo::Rpdo<X::Rooms>>>::LEN;

    /// Initialisation may take its time.
    const BOOTS_LATE: bool = match D::PROFILE {
        Some(profile) => profile.nmt.reset_node_us > 0 || profile.nmt.reset_communication_us > 0,
        None => true,
    };

    /// The node watches others: a master that guards, or a node that sends heartbeats.
    const HAS_MONITOR: bool = D::GUARDING || D::CONSUMER;

    /// Queues a frame, if there is room.
    fn push(&mut self, frame: Frame) -> bool {
        Room::queue_mut(&mut self.out).push(frame)
    }

    /// Something for the host to know.
    #[inline]
    fn event(&mut self, event: Event) {
        if D::EVENTS {
            Room::queue_mut(&mut self.events).push(event);
        }
    }

    /// It has started, and waits for LSS to give it a node ID.
    fn is_unconfigured(&self) -> bool {
        self.unconfigured && !self.boot_at.is_set() && self.mute.is_none()
    }

    /// The numbers of TPDOs and RPDOs, as far as the compiler knows them.
    const PDOS: Option<[usize; 2]> = match &D::DICTIONARY {
        Some(dictionary) if dictionary.tpdos() <= PDO && dictionary.rpdos() <= Self::RPDOS => {
            Some([dictionary.tpdos(), dictionary.rpdos()])
        }
        _ => None,
    };

    #[inline(always)]
    fn tpdo_count(&self) -> usize {
        match Self::PDOS {
            Some([tpdos, _]) => tpdos,
            None => self.tpdo_count.into(),
        }
    }

    #[inline(always)]
    fn rpdo_count(&self) -> usize {
        match Self::PDOS {
            Some([_, rpdos]) => rpdos,
            None => self.rpdo_count.into(),
        }
    }

    /// The TPDOs that the dictionary has.
    #[inline(always)]
    fn tpdos(&self) -> &[pdo::Tpdo<X::Rooms>] {
        self.tpdo.get(..self.tpdo_count()).unwrap_or_default()
    }

    /// The RPDOs that the dictionary has.
    #[inline(always)]
    fn rpdos(&self) -> &[pdo::Rpdo<X::Rooms>] {
        let rpdos = self.rpdo.all();
        rpdos.get(..self.rpdo_count()).unwrap_or_default()
    }

    #[inline]
    fn tpdos_mut(&mut self) -> &mut [pdo::Tpdo<X::Rooms>] {
        let count = self.tpdo_count();
        self.tpdo.get_mut(..count).unwrap_or_default()
    }

    #[inline]
    fn rpdos_mut(&mut self) -> &mut [pdo::Rpdo<X::Rooms>] {
        let count = self.rpdo_count();
        self.rpdo.all_mut().get_mut(..count).unwrap_or_default()
    }

    fn enter(&mut self, objects: &mut Objects<'_, D>, state: State) {
        if self.state == state {
            return;
        }
        // Its LSS hears nothing outside Stopped, so it is in configuration there alone.
        if D::LSS && objects.profile().lss.is_some_and(|lss| lss.stopped_only) {
            self.lss.all_mut().iter_mut().for_each(lss::Slave::leave);
        }
        self.state = state;
        self.event(Event::State(state));
        if D::SYNC_PRODUCER {
            self.configure_clocks(objects);
        }
        match state {
            State::Operational => self.start_pdos(objects),
            _ => self.stop_pdos(),
        }
        if state == State::Stopped {
            self.cut_transfers(objects);
        }
        self.listen(objects);
    }

    fn start_pdos(&mut self, objects: &mut Objects<'_, D>) {
        self.each_tpdo(|pdo| {
            pdo.start(objects);
            pdo.announce(objects);
        });
    }

    #[inline(never)]
    fn stop_pdos(&mut self) {
        for pdo in self.tpdos_mut() {
            pdo.stop();
        }
        if D::RPDOS {
            for pdo in self.rpdos_mut() {
                pdo.stop();
            }
        }
        self.pending &= !(pending::PDO | pending::MARKS);
    }

    /// Does something with each TPDO, after which it may be waiting to be sent.
    #[inline]
    fn each_tpdo(&mut self, mut act: impl FnMut(&mut pdo::Tpdo<X::Rooms>)) {
        let mut pending = false;
        for pdo in self.tpdos_mut() {
            act(pdo);
            pending |= pdo.is_pending();
        }
        self.pend_pdo(pending);
    }

    /// A TPDO may be waiting to be sent.
    #[inline(always)]
    fn pend_pdo(&mut self, pending: bool) {
        if pending {
            self.pending |= pending::PDO;
        }
    }
}
