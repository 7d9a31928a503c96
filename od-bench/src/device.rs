//! One device: dictionary, values, node, behaviour and storage in one piece.

use std::collections::VecDeque;
use std::prelude::v1::*;
use std::vec;

use od_model::Dictionary;
#[cfg(feature = "eds")]
use od_runtime::Application;
use od_runtime::encoder::Fault;
use od_runtime::storage::{Storage, image};
use od_runtime::{BusEvent, Event, Frame, Instant, Lent, NodeId, Profile, Reset};
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

mod copy;
mod power;
mod run;

use crate::behaviour::Behaviour;
#[cfg(feature = "eds")]
use crate::clock::Clock;
use crate::eeprom::Eeprom;
#[cfg(feature = "eds")]
use crate::long::{Beside, Long};
#[cfg(feature = "eds")]
use crate::programs::Programs;
#[cfg(feature = "serve")]
use crate::recorded::play::Playing;
use crate::roomy::roomy;
use crate::services::Services;
use crate::shaft;
use crate::slave::{Input, Slave};
use crate::source::Source;
use crate::twin::{Call, Twin};
use od_runtime::DeviceKind;

/// A CANopen device that lives in virtual time.
///
/// Drain [`poll_transmit`](Self::poll_transmit) after every call that takes a moment;
/// [`Bus`](crate::bus::Bus) does it for you.
pub struct VirtualDevice {
    title: String,
    pub(super) source: Source,
    pub(super) values: Vec<u8>,
    pub(super) node: Box<dyn Slave>,
    pub(super) behaviour: Behaviour,
    pub(super) storage: Eeprom,
    pub(super) profile: Profile,
    pub(super) services: Services,
    /// Of a device of a file.
    #[cfg(feature = "eds")]
    pub(super) long: Option<Long>,
    #[cfg(feature = "eds")]
    clock: Clock,
    #[cfg(feature = "eds")]
    pub(super) programs: Programs,
    pub(super) wanted_id: NodeId,
    pub(super) wanted_rate: Option<u16>,
    /// Time when the turning shaft is looked at again.
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
    /// Receives the calls of this device, too.
    pub(super) twin: Option<Box<dyn Twin>>,
    /// Knowledge of the node of a real bus that it describes.
    #[cfg(feature = "real")]
    pub(super) described: Option<crate::knowledge::Described>,
    /// Behaviour that another device was seen to have.
    #[cfg(feature = "serve")]
    pub(super) recorded: Option<Box<Playing>>,
}

/// Number of events that are kept until they are read.
const EVENTS: usize = 256;

impl VirtualDevice {
    /// A built-in device, without power, with an empty EEPROM in memory.
    pub fn new(kind: &DeviceKind, node_id: NodeId) -> Self {
        let behaviour = Behaviour::Encoder(Box::new(shaft::encoder(kind)));
        let source = Source::Compiled(kind.dictionary);
        let node = roomy(node_id, kind.dictionary);
        let device = Self::build(kind.title.into(), source, behaviour, *kind.profile, node);
        Self {
            channels: kind.channels,
            services: Services::default(),
            has_leds: kind.leds,
            ..device
        }
    }

    /// Number of devices like this one on its shaft, itself included: 2 for a redundant encoder,
    /// whose channels are nodes of their own. [`Bus::add_beside`](crate::bus::Bus::add_beside) puts
    /// the second one on the bus.
    pub fn channels(&self) -> u8 {
        self.channels
    }

    pub(super) fn build(
        title: String,
        source: Source,
        behaviour: Behaviour,
        profile: Profile,
        node: Box<dyn Slave>,
    ) -> Self {
        let dictionary = source.dictionary();
        let values = vec![0; dictionary.store_len()];
        let erased = vec![0xFF; needed(dictionary, &profile)];
        let services = Services::of(dictionary, profile.lss.is_some(), |_| false);
        Self {
            title,
            source,
            values,
            wanted_id: node.node_id(),
            node,
            behaviour,
            storage: Eeprom::own(erased),
            profile,
            services,
            #[cfg(feature = "eds")]
            long: None,
            #[cfg(feature = "eds")]
            clock: Clock::default(),
            #[cfg(feature = "eds")]
            programs: Programs::new(),
            wanted_rate: None,
            look_at: None,
            activated: None,
            raised: Vec::new(),
            events: VecDeque::new(),
            channels: 1,
            has_leds: true,
            twin: None,
            #[cfg(feature = "real")]
            described: None,
            #[cfg(feature = "serve")]
            recorded: None,
        }
    }

    /// Another EEPROM, with what is in it. Do it before power comes.
    #[must_use]
    pub fn with_storage(mut self, storage: Box<dyn Storage + Send>) -> Self {
        self.storage = Eeprom::lent(storage);
        self
    }

    /// Sets the device up for this bit rate in kbit/s, as for a bus line: an EEPROM that is empty at
    /// the first start contains it, if the device can save it.
    pub fn set_up_for(&mut self, rate: Option<u16>) {
        self.wanted_rate = rate;
    }

    /// With this many bytes for each string and DOMAIN that a master writes, or those of its default
    /// if that is longer. Without it a DOMAIN has 1 MiB, and a string what the file says: the length of
    /// its default, 64 bytes at least. Only a device of a file has such values; returns whether it is
    /// one. Do it before power comes.
    pub fn set_domain_size(&mut self, bytes: u32) -> bool {
        #[cfg(feature = "eds")]
        if let Some(long) = &mut self.long {
            long.size = Some(bytes as usize);
            return true;
        }
        let _ = bytes;
        false
    }

    /// Bytes that an EEPROM of this device needs.
    pub fn storage_needed(&self) -> usize {
        needed(self.dictionary(), &self.profile)
    }

    /// A name to show.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// A frame was received.
    pub fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        #[cfg(feature = "real")]
        if self.is_described() {
            return self.observe(frame);
        }
        #[cfg(feature = "serve")]
        if self.refuses_recorded(now, frame) {
            return;
        }
        self.handle(now, Input::Frame(frame));
        self.falls_dark(now);
    }

    /// Time has passed.
    pub fn handle_timeout(&mut self, now: Instant) {
        self.handle(now, Input::Timeout);
        if self.look_at.is_some_and(|at| at <= now) {
            self.noticed(now);
        }
        #[cfg(feature = "serve")]
        self.happens_recorded(now);
        self.falls_dark(now);
    }

    /// Power that went while the EEPROM was written went for all.
    fn falls_dark(&mut self, now: Instant) {
        if self.storage.is_cut() {
            self.power_off(now);
        }
    }

    /// The CAN controller has news: error counters, bus-off, a lost frame.
    pub fn handle_bus(&mut self, event: BusEvent, now: Instant) {
        self.handle(now, Input::Bus(event));
    }

    /// Something outside the bus changed.
    pub(super) fn noticed(&mut self, now: Instant) {
        self.handle(now, Input::Change);
        self.look_at = self.watches_shaft().then(|| now.plus_millis(1));
    }

    /// The next frame to send.
    pub fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        #[cfg(feature = "serve")]
        if self.recorded.is_some() {
            return self.poll_recorded(now);
        }
        if !self.node.may_transmit() {
            return None;
        }
        let frame = self.lend(|node, device| node.poll_transmit(device, now));
        if let (Some(twin), Some(frame)) = (&mut self.twin, &frame) {
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
        let due = earlier(
            due,
            self.recorded.as_ref().and_then(|playing| playing.due()),
        );
        due
    }

    /// Returns the oldest event; the last 256 are kept.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Hands an input on to the node.
    fn handle(&mut self, now: Instant, input: Input<'_>) {
        self.forward(now, Call::Input(input));
        self.lend(|node, device| node.handle(device, now, input));
        self.take_events();
    }

    /// Keeps the events of the node for [`poll_event`](Self::poll_event), and acts on those that
    /// the world outside the node has to know.
    pub(super) fn take_events(&mut self) {
        while let Some(event) = self.node.poll_event() {
            self.take_event(event);
        }
    }

    fn take_event(&mut self, event: Event) {
        if let Some(twin) = &mut self.twin {
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
        self.source.dictionary()
    }

    /// Lends the device to the node for a call.
    pub(super) fn lend<R>(&mut self, call: impl FnOnce(&mut dyn Slave, &mut Lent<'_>) -> R) -> R {
        let Self {
            source,
            values,
            node,
            behaviour,
            storage,
            profile,
            #[cfg(feature = "eds")]
            long,
            #[cfg(feature = "eds")]
            clock,
            #[cfg(feature = "eds")]
            programs,
            ..
        } = self;
        if let Behaviour::Encoder(encoder) = behaviour {
            storage.broken = encoder.is_broken(Fault::Memory);
        }
        let application = behaviour.as_application();
        #[cfg(feature = "eds")]
        let mut beside;
        #[cfg(feature = "eds")]
        let application: &mut dyn Application = match long {
            Some(long) => {
                beside = Beside {
                    application,
                    long,
                    clock,
                    programs,
                };
                &mut beside
            }
            None => application,
        };
        let mut device = Lent {
            dictionary: source.dictionary(),
            values,
            application,
            storage,
            profile: Some(profile),
        };
        call(&mut **node, &mut device)
    }
}

/// The earlier of two moments, if there is one.
#[inline]
fn earlier(one: Option<Instant>, other: Option<Instant>) -> Option<Instant> {
    match (one, other) {
        (Some(one), Some(other)) => Some(one.min(other)),
        _ => one.or(other),
    }
}

/// Bytes of EEPROM for the values of a dictionary, and for what LSS stores beside them.
fn needed(dictionary: Dictionary<'_>, profile: &Profile) -> usize {
    let own = match profile.lss {
        Some(lss) if lss.is_own() => image::OWN_CAPACITY,
        _ => 0,
    };
    image::capacity_needed(&dictionary) + own
}
