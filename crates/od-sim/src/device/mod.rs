//! One device: a node and the world around it.
//!
//! | file | what it holds |
//! |---|---|
//! | `compiled`, `loaded` | a device that the compiler knows, of a file |
//! | `role`, `described` | the node that it is on the bus: simulated, recorded, or real |
//! | `source`, `application` | its dictionary, its behaviour |
//! | `eeprom`, `saved` | its non-volatile memory, and how it is seen from outside |
//! | `world`, `pins`, `leds` | its shaft, switches, faults, connections and LEDs |
//! | `identity`, `own`, `view` | its serial number and LSS address; changes from its side; its values |
//! | `twin`, `forward` | the other implementation that receives the calls of the device, too |
//! | `file_parts`, `streams`, `clock`, `programs` | parts that only a device of a file has: long values, TIME, program download |
//! | `services`, `left_out` | services of an EDS; the defaults that it leaves out |
//! | `pdos`, `configured` | its PDOs and its configuration as they are now |
//! | `notice` | events of the storage in words |

pub(crate) mod application;
#[cfg(feature = "eds")]
pub(crate) mod clock;
pub(crate) mod compiled;
#[cfg(feature = "eds")]
pub(crate) mod configured;
#[cfg(feature = "real")]
pub(crate) mod described;
pub(crate) mod eeprom;
#[cfg(feature = "eds")]
pub(crate) mod file_parts;
pub(crate) mod forward;
pub(crate) mod identity;
pub(crate) mod leds;
#[cfg(feature = "eds")]
pub(crate) mod left_out;
#[cfg(feature = "eds")]
pub(crate) mod loaded;
pub mod notice;
pub(crate) mod own;
pub mod pdos;
pub(crate) mod pins;
#[cfg(feature = "eds")]
pub(crate) mod programs;
pub(crate) mod role;
pub(crate) mod saved;
pub(crate) mod services;
pub(crate) mod source;
#[cfg(feature = "eds")]
pub(crate) mod streams;
pub mod twin;
pub(crate) mod view;
pub(crate) mod world;

use std::collections::VecDeque;
use std::prelude::v1::*;
use std::vec;

use od_model::Dictionary;
use od_runtime::encoder::Fault;
use od_runtime::storage::{Storage, image};
use od_runtime::{BusEvent, DeviceKind, Event, Frame, Instant, NodeId, Profile, Reset, kind};
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

use crate::device::application::{Behaviour, DeviceApplication};
use crate::device::eeprom::Eeprom;
use crate::device::role::Role;
use crate::device::services::Services;
use crate::device::source::{Loaded, Source};
use crate::device::twin::{Call, TwinSlot};
use crate::shaft;

/// The node of a device on a bench.
pub(crate) type Node = od_runtime::Node<Loaded, DeviceApplication, Eeprom>;

/// A CANopen device that lives in virtual time.
///
/// Call [`poll_transmit`](Self::poll_transmit) until it returns `None` after each call with `now`;
/// [`Bus`](crate::bus::Bus) does it for you. A copy continues as this device would, but its EEPROM is in memory, and it
/// has no [twin](Self::with_twin).
#[derive(Clone)]
pub struct VirtualDevice {
    title: String,
    pub(super) node: Node,
    pub(super) services: Services,
    pub(super) wanted_id: NodeId,
    pub(super) wanted_rate: Option<u16>,
    /// Time when the position of a turning shaft is checked again.
    look_at: Option<Instant>,
    /// The bit rate that LSS activated since the last start, in kbit/s.
    pub(super) activated: Option<u16>,
    /// Errors that were reported from outside since the last start.
    pub(super) raised: Vec<Emcy>,
    /// Events for [`poll_event`](Self::poll_event).
    events: VecDeque<Event>,
    /// Channels on its shaft, as [`DeviceKind::channels`].
    channels: u8,
    pub(super) has_leds: bool,
    /// The other implementation that receives the calls of this device, too.
    pub(super) twin: TwinSlot,
    /// The node that it is on the bus.
    pub(super) role: Role,
}

/// Number of events that are kept until they are read.
const EVENTS: usize = 256;

impl VirtualDevice {
    /// A built-in device, without power, with an empty EEPROM in memory.
    pub fn new(kind: &DeviceKind, node_id: NodeId) -> Self {
        let behaviour = match kind.behaviour {
            kind::Behaviour::Encoder(profile) => {
                Behaviour::Encoder(Box::new(shaft::encoder(profile, kind.dictionary)))
            }
            kind::Behaviour::Own(make) => Behaviour::Own(make()),
        };
        let loaded = Loaded {
            source: Source::Compiled(kind.dictionary),
            profile: *kind.profile,
        };
        let device = Self::build(kind.title.into(), loaded, node_id, behaviour.into());
        Self {
            channels: kind.channels,
            services: Services::default(),
            has_leds: kind.leds,
            ..device
        }
    }

    pub(super) fn build(
        title: String,
        device: Loaded,
        node_id: NodeId,
        application: DeviceApplication,
    ) -> Self {
        let dictionary = device.source.dictionary();
        let services = Services::of(dictionary, device.profile.lss.is_some(), |_| false);
        let erased = vec![0xFF; needed(dictionary, &device.profile)];
        let mut made = Self {
            title,
            node: Node::new(device, node_id, application, Eeprom::own(erased)),
            services,
            wanted_id: node_id,
            wanted_rate: None,
            look_at: None,
            activated: None,
            raised: Vec::new(),
            events: VecDeque::new(),
            channels: 1,
            has_leds: true,
            twin: TwinSlot::default(),
            role: Role::Node,
        };
        made.break_storage();
        made
    }

    /// Number of devices like this one on its shaft, itself included: 2 for a redundant encoder,
    /// whose channels are nodes of their own. [`Bus::add_beside`](crate::bus::Bus::add_beside) puts
    /// the second one on the bus.
    pub fn channels(&self) -> u8 {
        self.channels
    }

    /// The same device with another EEPROM and its content. Call it before the power is switched on.
    #[must_use]
    pub fn with_storage(mut self, storage: Box<dyn Storage + Send>) -> Self {
        self.node.storage = Eeprom::lent(storage);
        self.break_storage();
        self
    }

    /// Sets the bit rate of the bus line, in kbit/s: at its first start a device that can save a bit rate writes it
    /// into an empty EEPROM.
    pub(crate) fn set_up_for(&mut self, rate: Option<u16>) {
        self.wanted_rate = rate;
    }

    /// Sets the limit of each string and DOMAIN that a master writes, in bytes; a longer default raises it. Before
    /// this call the limit is 1 MiB for a DOMAIN, and for a string the length of its default, 64 bytes at least.
    /// Returns whether the device comes from a file; only such a device has these values. Call it before the power
    /// is switched on.
    pub fn set_domain_size(&mut self, bytes: u32) -> bool {
        #[cfg(feature = "eds")]
        if let Some(parts) = &mut self.node.application.file_parts {
            parts.long.size = Some(bytes as usize);
            return true;
        }
        let _ = bytes;
        false
    }

    /// Size that an EEPROM for this device needs, in bytes.
    pub fn storage_needed(&self) -> usize {
        needed(self.dictionary(), self.profile())
    }

    /// Name of the device, for a person.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Handles a frame from the bus.
    pub fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        #[cfg(feature = "real")]
        if self.is_described() {
            return self.observe(frame);
        }
        #[cfg(feature = "serve")]
        if self.refuses_recorded(now, frame) {
            return;
        }
        self.call(now, Call::Frame(frame), |node| {
            node.handle_frame(now, frame);
        });
        self.power_off_if_cut(now);
    }

    /// Does the work that is due at `now`.
    pub fn handle_timeout(&mut self, now: Instant) {
        self.call(now, Call::Timeout, |node| node.handle_timeout(now));
        if self.look_at.is_some_and(|at| at <= now) {
            self.noticed(now);
        }
        #[cfg(feature = "serve")]
        self.happens_recorded(now);
        self.power_off_if_cut(now);
    }

    /// Switches the device off if the power failed during a write to the EEPROM.
    fn power_off_if_cut(&mut self, now: Instant) {
        if self.node.storage.is_cut() {
            self.power_off(now);
        }
    }

    /// Handles a change of the CAN controller: its error state, or a lost frame.
    pub fn handle_bus(&mut self, event: BusEvent, now: Instant) {
        self.call(now, Call::Bus(event), |node| node.handle_bus(now, event));
    }

    /// Tells the node that something outside the bus changed.
    pub(super) fn noticed(&mut self, now: Instant) {
        self.call(now, Call::Change, |node| node.handle_change(now));
        self.look_at = self.watches_shaft().then(|| now.plus_millis(1));
    }

    /// The next frame to send.
    pub fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        #[cfg(feature = "serve")]
        if matches!(self.role, Role::Recorded(_)) {
            return self.poll_recorded(now);
        }
        if !self.node.may_transmit() {
            return None;
        }
        let frame = self.node.poll_transmit(now);
        if let (Some(twin), Some(frame)) = (&mut self.twin.0, &frame) {
            twin.sent(frame);
        }
        frame
    }

    /// Time when [`handle_timeout`](Self::handle_timeout) is due.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let due = self.node.poll_timeout();
        let is_operational = |_: &Instant| self.node.state() == State::Operational;
        let due = earlier(due, self.look_at.filter(is_operational));
        #[cfg(feature = "serve")]
        if let Role::Recorded(playing) = &self.role {
            return earlier(due, playing.due());
        }
        due
    }

    /// Returns the oldest event; the last 256 are kept.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Keeps the events of the node for [`poll_event`](Self::poll_event), and acts on those that
    /// the world outside the node has to know. Returns whether there were any.
    pub(super) fn take_events(&mut self) -> bool {
        let mut any = false;
        while let Some(event) = self.node.poll_event() {
            self.take_event(event);
            any = true;
        }
        any
    }

    fn take_event(&mut self, event: Event) {
        if let Some(twin) = &mut self.twin.0 {
            twin.happened(&event);
        }
        match event {
            Event::BitRate(code) => self.activated = self.bit_rate_of(code),
            Event::Reset(Reset::PowerOn | Reset::Node, _) => {
                self.activated = None;
                self.raised.clear();
            }
            _ => {}
        }
        if self.events.len() == EVENTS {
            self.events.pop_front();
        }
        self.events.push_back(event);
    }

    /// The NMT state.
    pub fn state(&self) -> State {
        #[cfg(feature = "real")]
        if let Some(state) = self.seen_state() {
            return state;
        }
        self.node.state()
    }

    /// The active node ID.
    pub fn node_id(&self) -> NodeId {
        self.node.node_id()
    }

    /// The object dictionary.
    pub fn dictionary(&self) -> Dictionary<'_> {
        self.node.device().source.dictionary()
    }

    /// Options and deviations of its family relative to CiA 301.
    pub(super) fn profile(&self) -> &Profile {
        &self.node.device().profile
    }

    /// Makes the EEPROM refuse writes while the fault of the memory is set.
    pub(super) fn break_storage(&mut self) {
        let encoder = self.node.application.encoder();
        self.node.storage.broken = encoder.is_some_and(|one| one.is_broken(Fault::Memory));
    }

    /// Switches the power on. A device with an object for its node ID (2101h) and an empty EEPROM starts with the
    /// node ID that it was made with.
    pub fn power_on(&mut self, now: Instant) {
        if self.is_powered() {
            return;
        }
        if let Some(memory) = self.node.storage.memory() {
            memory.restore_power();
        }
        self.node.storage.fails = false;
        self.configure_node_id();
        self.call(now, Call::PowerOn, |node| node.power_on(now));
    }

    /// Ends an initialisation that takes time: the node boots up now.
    pub(crate) fn boot_at_once(&mut self, now: Instant) {
        self.call(now, Call::Boot, |node| node.boot_at_once(now));
    }

    /// Switches the power off. The shaft keeps turning.
    pub fn power_off(&mut self, now: Instant) {
        self.forward(now, Call::PowerOff);
        if let Some(encoder) = self.node.application.encoder_mut() {
            encoder.power_off(now);
        }
        self.node.power_off();
        #[cfg(feature = "serve")]
        if let Role::Recorded(playing) = &mut self.role {
            playing.stop();
        }
    }

    /// Returns whether its CAN controller is bus-off.
    pub(crate) fn is_bus_off(&self) -> bool {
        self.node.is_bus_off()
    }

    /// Returns whether it has power. A device that describes a node of a real bus always has.
    pub fn is_powered(&self) -> bool {
        #[cfg(feature = "real")]
        if self.is_described() {
            return true;
        }
        self.node.is_powered()
    }

    /// Handles the deadlines of the device until `to`, or until it has sent `frames` frames or reports an event; `now`
    /// becomes that time. Returns whether more deadlines may be due at `now`. `None`: each call has
    /// to be made one by one, for example because a twin needs it.
    pub(crate) fn run(
        &mut self,
        now: &mut Instant,
        to: Instant,
        mut frames: usize,
        mut sent: impl FnMut(Instant, Frame),
    ) -> Option<bool> {
        let is_node = matches!(self.role, Role::Node);
        if !is_node || self.twin.0.is_some() || self.look_at.is_some() || self.node.storage.fails {
            return None;
        }
        while frames > 0
            && let Some(at) = self.node.poll_timeout()
            && at <= to
        {
            *now = at.max(*now);
            self.node.handle_timeout(*now);
            while let Some(frame) = self.node.poll_transmit(*now) {
                frames = frames.saturating_sub(1);
                sent(*now, frame);
            }
            let has_events = self.take_events();
            let again = self.node.poll_timeout().is_some_and(|again| again <= *now);
            if again || has_events {
                return Some(true);
            }
        }
        Some(false)
    }
}

/// The earlier of two moments; `None` if there is none.
#[inline]
fn earlier(one: Option<Instant>, other: Option<Instant>) -> Option<Instant> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.min(other)),
        _ => one.or(other),
    }
}

/// Size of an EEPROM for the values of a dictionary and those that LSS stores, in bytes.
fn needed(dictionary: Dictionary<'_>, profile: &Profile) -> usize {
    let own = match profile.lss {
        Some(lss) if lss.is_own() => image::OWN_CAPACITY,
        _ => 0,
    };
    image::capacity_needed(&dictionary) + own
}
