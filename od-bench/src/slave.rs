//! A node whatever its type: the bench runs those of compiled devices with their own sizes.

use core::any::Any;
use core::iter;
use std::prelude::v1::*;

use od_model::Address;
use od_runtime::{
    BusEvent, Device, Event, Extras, Frame, Instant, Lent, Node, NodeId, StoreTooSmall,
};
use od_wire::AbortCode;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

/// Something that a node handles.
#[derive(Clone, Copy, Debug)]
pub enum Input<'f> {
    /// A frame was received.
    Frame(&'f Frame),
    /// A deadline is due.
    Timeout,
    /// The CAN controller has news.
    Bus(BusEvent),
    /// Something outside the bus changed.
    Change,
    /// The initialisation ends at once.
    Boot,
}

/// A time in which nothing happens to a node but that its deadlines come.
pub(crate) struct Stretch {
    /// The present moment.
    pub(crate) now: Instant,
    /// Its end.
    pub(crate) to: Instant,
    /// Number of sent frames that ends it earlier.
    pub(crate) frames: usize,
    /// Events at its end; the first one ends it.
    pub(crate) events: Vec<Event>,
}

/// The functions of [`Node`] that a bench calls; see there.
pub(crate) trait Slave: Any + Send {
    fn power_on(&mut self, device: &mut Lent<'_>, now: Instant) -> Result<(), StoreTooSmall>;
    fn power_off(&mut self);
    fn handle(&mut self, device: &mut Lent<'_>, now: Instant, input: Input<'_>);
    fn set_value(
        &mut self,
        device: &mut Lent<'_>,
        now: Instant,
        address: Address,
        bytes: &[u8],
    ) -> Result<(), AbortCode>;
    fn change_error(&mut self, device: &mut Lent<'_>, now: Instant, error: Emcy, on: bool) -> bool;
    fn may_transmit(&self) -> bool;
    fn poll_transmit(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame>;
    fn poll_timeout(&self) -> Option<Instant>;
    fn poll_event(&mut self) -> Option<Event>;
    /// Lets time pass, and hands over what is sent. Returns whether a deadline was met at the moment that it
    /// is now, so that there may be more to do at it.
    fn run(
        &mut self,
        device: &mut Lent<'_>,
        stretch: &mut Stretch,
        sent: &mut dyn FnMut(Instant, Frame),
    ) -> bool;
    fn state(&self) -> State;
    fn node_id(&self) -> NodeId;
    fn set_node_id(&mut self, node_id: Option<NodeId>);
    fn is_configured(&self) -> bool;
    fn is_powered(&self) -> bool;
    fn is_bus_off(&self) -> bool;
}

impl<D, const PDO: usize, const SDO: usize, X> Slave for Node<D, PDO, SDO, X>
where
    D: Device + Send + 'static,
    X: Extras<D, SDO> + Send + 'static,
{
    /// A file may ask for more than the node serves: more TPDOs, say. What a compiled
    /// device has fits its node, or it would not compile.
    fn power_on(&mut self, device: &mut Lent<'_>, now: Instant) -> Result<(), StoreTooSmall> {
        self.power_on_partly(device, now)
    }

    fn power_off(&mut self) {
        self.power_off();
    }

    fn handle(&mut self, device: &mut Lent<'_>, now: Instant, input: Input<'_>) {
        match input {
            Input::Frame(frame) => self.handle_frame(device, now, frame),
            Input::Timeout => self.handle_timeout(device, now),
            Input::Bus(event) => self.handle_bus(device, now, event),
            Input::Change => self.handle_change(device, now),
            Input::Boot => self.boot_at_once(device, now),
        }
    }

    fn set_value(
        &mut self,
        device: &mut Lent<'_>,
        now: Instant,
        address: Address,
        bytes: &[u8],
    ) -> Result<(), AbortCode> {
        self.set_value(device, now, address, bytes)
    }

    fn change_error(&mut self, device: &mut Lent<'_>, now: Instant, error: Emcy, on: bool) -> bool {
        match on {
            true => self.raise(device, now, error),
            false => self.clear(device, now, error),
        }
    }

    fn may_transmit(&self) -> bool {
        self.may_transmit()
    }

    fn poll_transmit(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        self.poll_transmit(device, now)
    }

    fn poll_timeout(&self) -> Option<Instant> {
        self.poll_timeout()
    }

    fn poll_event(&mut self) -> Option<Event> {
        self.poll_event()
    }

    fn run(
        &mut self,
        device: &mut Lent<'_>,
        stretch: &mut Stretch,
        sent: &mut dyn FnMut(Instant, Frame),
    ) -> bool {
        while stretch.frames > 0
            && let Some(at) = self.poll_timeout()
            && at <= stretch.to
        {
            let now = at.max(stretch.now);
            stretch.now = now;
            self.handle_timeout(device, now);
            while let Some(frame) = self.poll_transmit(device, now) {
                stretch.frames = stretch.frames.saturating_sub(1);
                sent(now, frame);
            }
            stretch.events.extend(iter::from_fn(|| self.poll_event()));
            let again = self.poll_timeout().is_some_and(|again| again <= now);
            if again || !stretch.events.is_empty() {
                return true;
            }
        }
        false
    }

    fn state(&self) -> State {
        self.state()
    }

    fn node_id(&self) -> NodeId {
        self.node_id()
    }

    fn set_node_id(&mut self, node_id: Option<NodeId>) {
        self.set_node_id(node_id);
    }

    fn is_configured(&self) -> bool {
        self.is_configured()
    }

    fn is_powered(&self) -> bool {
        self.is_powered()
    }

    fn is_bus_off(&self) -> bool {
        self.is_bus_off()
    }
}
