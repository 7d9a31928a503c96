//! The node: the only module that imports all services.
//!
//! ```text
//! power_on ─┐                       ┌─> poll_transmit   frames
//! handle_frame ──> services ──────> ├─> poll_timeout    next deadline
//! handle_timeout ┘                  └─> poll_event      what happened
//! ```
//! Call `poll_transmit` until it returns `None` after every input, then sleep until `poll_timeout`
//! or the next frame. The outputs depend only on the inputs and their order.
//!
//! - [`input`]: a frame, a moment, a change that the device itself makes, and the service that handles it.
//! - [`output`]: frames, the next deadline, events.
//! - [`listening`]: the table of the CAN-IDs that the node listens to.
//! - [`boot`]: power-on, resets, and the configuration of all services.
//! - [`effects`]: work at the end of a call.
//! - `servers`, `clocks`, `bus`, `errors`: SDO, SYNC and TIME, the CAN controller, error behaviour.

mod boot;
mod bus;
mod clocks;
mod controller;
mod effects;
mod errors;
pub(crate) mod event;
mod input;
mod listening;
mod output;
mod servers;

use core::fmt;

use od_model::typed::{DeviceWritable, Scalar, Var};
use od_wire::nmt::State;
use od_wire::{CanId, Frame, Instant, NodeId};

use crate::application::{Application, NoApplication};
use crate::deadline::Deadline;
use crate::device::Device;
use crate::objects::Objects;
use crate::rooms::{Lent, Rooms, Values};
use crate::services::assert_served;
use crate::storage::{NoStorage, Storage};
use crate::store::Store;
use crate::{emcy, error_control, pdo, sync};

pub use controller::BusEvent;
pub use event::Event;

/// A CANopen node: a device with its values, its behaviour and its memory for saved values.
///
/// `D` is the device: its object dictionary, its profile and its services. `object_dictionary!`
/// makes such a type for each module. `A` is the behaviour ([`Application`]), `S` the non-volatile
/// memory ([`Storage`]) for the values saved with 1010h.
///
/// A node has no clock and does no I/O. Call [`handle_frame`](Self::handle_frame),
/// [`handle_timeout`](Self::handle_timeout) and [`change`](Self::change) with the present time.
/// After each call, call [`poll_transmit`](Self::poll_transmit) until it returns no frame, then
/// wait for the next frame or for [`poll_timeout`](Self::poll_timeout), whichever is first. The
/// [documentation of the crate](crate) shows the loop.
pub struct Node<D: Device, A = NoApplication, S = NoStorage> {
    machines: Machines<D>,
    values: D::Values,
    device: D,
    /// Behaviour of the device. After a change call [`handle_change`](Self::handle_change), or use
    /// [`change`](Self::change).
    pub application: A,
    /// Memory for the values saved with 1010h.
    pub storage: S,
}

/// State of the node: NMT, deadlines, and the state of each service.
struct Machines<D: Device> {
    state: State,
    powered: bool,
    /// No frame waits to be sent.
    idle: bool,
    node_id: NodeId,
    /// The node ID is FFh (CiA 305), and only LSS works. The flag is not named `configured`, so
    /// that a node without power is all zeros and a static node takes no flash.
    unconfigured: bool,
    /// The error behaviour requests a reset at the end of the call.
    reset_due: bool,
    /// Heartbeat or guarding failed in this call, and 1029h:01 has not been carried out yet.
    lost: bool,
    /// Whether a monitored node was lost at the last check.
    was_lost: bool,
    /// At least one TPDO is sent when a mapped value changes.
    watches_changes: bool,
    /// At least one such value may change without notifying the node.
    watches_live: bool,
    /// The CAN-IDs that the node listens to may have changed since the host asked for them.
    wanted_changed: bool,
    /// CAN-IDs of SYNC, EMCY and TIME that were refused, as bits.
    refused: u8,
    /// Number of CAN-IDs that the node listens to.
    listeners: u16,
    /// Last report of the CAN controller, except overruns.
    bus: BusEvent,
    /// Node ID of the first start, if the saved values contain it
    /// ([`LssProfile::is_own`](crate::LssProfile::is_own)).
    made_with: NodeId,
    /// The node was made without a node ID.
    made_unconfigured: bool,
    now: Instant,
    /// Earliest deadline, without those of waiting frames; [`Instant::ZERO`]: not computed,
    /// [`Instant::MAX`]: none.
    next: Instant,
    /// Time of the boot-up message; only while initialising.
    boot_at: Deadline,
    tick_at: Deadline,
    heartbeat: error_control::Producer,
    /// Time without frames: LSS activates a bit rate, or the CAN controller is bus-off.
    mute: Option<controller::Mute>,
    /// `None`: the CAN-ID in 1005h belongs to no service (restricted, or not valid).
    sync_id: Option<CanId>,
    sync_length: sync::Length,
    emcy: emcy::State,
    rooms: D::Rooms,
}

impl<D: Device, A, S> Node<D, A, S> {
    /// Makes a node without power. It starts with this node ID, unless the application or the saved
    /// values set another.
    ///
    /// Does not compile if the dictionary of `D` has objects of a service that the device switched
    /// off.
    pub const fn new(device: D, node_id: NodeId, application: A, storage: S) -> Self {
        const { assert_served::<D>() };
        Self {
            machines: Machines::new(node_id),
            values: D::Values::NEW,
            device,
            application,
            storage,
        }
    }

    /// Returns device, application and storage, and drops the node.
    pub fn into_parts(self) -> (D, A, S) {
        (self.device, self.application, self.storage)
    }

    /// The device.
    pub const fn device(&self) -> &D {
        &self.device
    }

    /// The device, to change facts that are known only at run time. Call this without power.
    pub const fn device_mut(&mut self) -> &mut D {
        &mut self.device
    }

    /// The NMT state.
    pub const fn state(&self) -> State {
        self.machines.state
    }

    /// Returns whether the node has power.
    pub const fn is_powered(&self) -> bool {
        self.machines.powered
    }

    /// The active node ID.
    pub const fn node_id(&self) -> NodeId {
        self.machines.node_id
    }

    /// Sets the node ID of the next power-on, unless the application or the saved values set
    /// another. A device of [`LssProfile::CIA305`](crate::LssProfile::CIA305) uses it until LSS has
    /// stored a node ID. `None`: such a device is not configured, and only LSS works until a master
    /// gives it a node ID.
    pub const fn set_node_id(&mut self, node_id: Option<NodeId>) {
        let node = &mut self.machines;
        node.made_unconfigured = node_id.is_none();
        if let Some(node_id) = node_id {
            node.made_with = node_id;
        }
        if !node.powered {
            node.unconfigured = node_id.is_none();
            node.node_id = node.made_with;
        }
    }

    /// Returns whether the node has a node ID; without one only LSS works.
    pub const fn is_configured(&self) -> bool {
        !self.machines.unconfigured
    }

    /// Returns whether the CAN controller is bus-off, as reported by
    /// [`handle_bus`](Self::handle_bus). The node neither sends nor receives then.
    pub const fn is_bus_off(&self) -> bool {
        self.machines.is_bus_off()
    }

    /// The current values, in the layout of [`Store`].
    pub fn values(&self) -> &[u8] {
        self.values.bytes()
    }

    /// Calls `act` with the application and the values. The node sends nothing for what `act`
    /// changes; use [`change`](Self::change) for that.
    pub fn look<R>(&mut self, act: impl FnOnce(&mut A, &mut Store<'_>) -> R) -> R {
        let local;
        let dictionary = match &D::DICTIONARY {
            Some(dictionary) => dictionary,
            None => {
                local = self.device.dictionary();
                &local
            }
        };
        let Lent { bytes, .. } = self.values.lend();
        let mut store = Store::over(dictionary, bytes, self.machines.node_id);
        act(&mut self.application, &mut store)
    }

    /// The current value of a handle.
    pub fn get<T: Scalar, B, M>(&mut self, var: Var<T, B, M>) -> T {
        self.look(|_, store| store.get(var))
    }
}

impl<D: Device, A: Application, S: Storage> Node<D, A, S> {
    /// Changes the application or values as the device itself does. Event-driven TPDOs of changed
    /// values are sent at once.
    pub fn change<R>(&mut self, now: Instant, act: impl FnOnce(&mut A, &mut Store<'_>) -> R) -> R {
        let result = self.look(act);
        self.handle_change(now);
        result
    }

    /// Sets the value of a handle, as [`change`](Self::change) does.
    pub fn set<T: Scalar, B: DeviceWritable, M>(
        &mut self,
        now: Instant,
        var: Var<T, B, M>,
        value: T,
    ) {
        self.change(now, |_, store| store.set(var, value));
    }

    /// Begins every call: takes the machines of the services, and the objects that they work on.
    /// `None` without power.
    ///
    /// A time before that of the last call is treated as that of the last call: time does not run backwards.
    fn call<R>(
        &mut self,
        now: Instant,
        act: impl FnOnce(&mut Machines<D>, &mut Objects<'_, D>) -> R,
    ) -> Option<R> {
        let Self {
            machines,
            values,
            device,
            application,
            storage,
        } = self;
        if !machines.powered {
            return None;
        }
        machines.now = machines.now.max(now);
        machines.next = Instant::ZERO;
        machines.idle = false;
        let local;
        let dictionary = match &D::DICTIONARY {
            Some(dictionary) => dictionary,
            None => {
                local = device.dictionary();
                &local
            }
        };
        let Lent {
            bytes,
            outbox,
            saving,
        } = values.lend();
        let mut objects = Objects {
            device: core::marker::PhantomData,
            store: Store::over(dictionary, bytes, machines.node_id),
            application,
            storage,
            profile: device.profile(),
            now: machines.now,
            outbox,
            saving,
        };
        Some(act(machines, &mut objects))
    }
}

impl<D: Device + Clone, A: Clone, S: Clone> Clone for Node<D, A, S>
where
    D::Values: Clone,
    D::Rooms: Clone,
{
    fn clone(&self) -> Self {
        let machines = &self.machines;
        Self {
            machines: Machines {
                heartbeat: machines.heartbeat,
                mute: machines.mute,
                emcy: machines.emcy.clone(),
                rooms: machines.rooms.clone(),
                ..*machines
            },
            values: self.values.clone(),
            device: self.device.clone(),
            application: self.application.clone(),
            storage: self.storage.clone(),
        }
    }
}

impl<D: Device, A: fmt::Debug, S: fmt::Debug> fmt::Debug for Node<D, A, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Node")
            .field("node_id", &self.machines.node_id)
            .field("state", &self.machines.state)
            .field("application", &self.application)
            .field("storage", &self.storage)
            .finish_non_exhaustive()
    }
}

impl<D: Device> Machines<D> {
    const fn new(node_id: NodeId) -> Self {
        Self {
            node_id,
            made_with: node_id,
            made_unconfigured: false,
            unconfigured: false,
            state: State::Initialising,
            powered: false,
            idle: false,
            now: Instant::ZERO,
            boot_at: Deadline::NEVER,
            tick_at: Deadline::NEVER,
            next: Instant::ZERO,
            sync_id: None,
            sync_length: sync::Length::Any,
            listeners: 0,
            heartbeat: error_control::Producer::new(),
            mute: None,
            bus: BusEvent::Active,
            reset_due: false,
            lost: false,
            was_lost: false,
            emcy: emcy::State::NEW,
            watches_changes: false,
            watches_live: false,
            wanted_changed: false,
            refused: 0,
            rooms: D::Rooms::NEW,
        }
    }

    /// Queues a frame, if there is room.
    fn push(&mut self, frame: Frame) -> bool {
        self.rooms.all_mut().frames.push(frame)
    }

    /// Queues an event for the host.
    fn event(&mut self, event: Event) {
        if D::EVENTS {
            self.rooms.all_mut().events.push(event);
        }
    }

    /// Returns whether the node has started and waits for LSS to give it a node ID.
    fn is_unconfigured(&self) -> bool {
        self.unconfigured && !self.boot_at.is_set() && self.mute.is_none()
    }

    fn emcy(&mut self) -> emcy::Producer<'_> {
        let rooms = self.rooms.all_mut();
        emcy::Producer {
            active: rooms.errors,
            waiting: rooms.messages,
            state: &mut self.emcy,
        }
    }

    /// The monitor of other nodes: heartbeat and guarding.
    fn monitor(&mut self) -> error_control::Monitor<'_> {
        let rooms = self.rooms.all_mut();
        error_control::Monitor {
            guards: rooms.guards,
            watches: rooms.watches,
            lost: &mut self.was_lost,
        }
    }

    /// Enters an NMT state (CiA 301, chapters 7.3.2.1 and 7.3.2.2.2 to 7.3.2.2.4): informs host and application, and
    /// starts or stops the services that work in this state only.
    fn enter(&mut self, objects: &mut Objects<'_, D>, state: State) {
        if self.state == state {
            return;
        }
        // This family handles LSS in Stopped only, so only there it can be in the configuration
        // state.
        if D::LSS && objects.profile.lss.is_some_and(|lss| lss.stopped_only) {
            self.rooms
                .all_mut()
                .lss
                .iter_mut()
                .for_each(|lss| lss.leave());
        }
        self.state = state;
        self.event(Event::State(state));
        objects.application(|application, cx| application.state_is(cx, state));
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
    }

    fn start_pdos(&mut self, objects: &mut Objects<'_, D>) {
        self.each_tpdo(|pdo, mapped| {
            pdo.start(objects, mapped);
            pdo.announce(objects);
        });
    }

    fn stop_pdos(&mut self) {
        let rooms = self.rooms.all_mut();
        rooms.tpdos.iter_mut().for_each(|pdo| pdo.stop());
        rooms.rpdos.iter_mut().for_each(|pdo| pdo.stop());
    }

    /// Calls `act` with each TPDO and the array of all mapping entries.
    fn each_tpdo(&mut self, mut act: impl FnMut(&mut pdo::Tpdo, &[pdo::Mapped])) {
        let rooms = self.rooms.all_mut();
        for pdo in rooms.tpdos {
            act(pdo, rooms.mapped);
        }
    }
}
