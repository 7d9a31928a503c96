//! The node in the form that the parts of this crate use.

use od_runtime::storage::Storage;
use od_runtime::{Application, BusEvent, Device, Event, Frame, Instant, Node};
use od_wire::CanId;

/// A [`Node`] with any device, application and storage. The functions are those of [`Node`].
pub trait Owner {
    /// Handles a frame that was received.
    fn handle_frame(&mut self, now: Instant, frame: &Frame);

    /// Carries out what is due at `now`.
    fn handle_timeout(&mut self, now: Instant);

    /// Tells the application that the world outside the bus changed.
    fn handle_change(&mut self, now: Instant);

    /// Reports a state change or frame loss of the CAN controller.
    fn handle_bus(&mut self, now: Instant, event: BusEvent);

    /// Returns whether the CAN controller is bus-off, as reported by
    /// [`handle_bus`](Self::handle_bus).
    fn is_bus_off(&self) -> bool;

    /// Returns the next frame to send, or `None` when all are sent.
    fn poll_transmit(&mut self, now: Instant) -> Option<Frame>;

    /// Time of the next call of [`handle_timeout`](Self::handle_timeout).
    fn poll_timeout(&self) -> Option<Instant>;

    /// Returns the oldest pending event.
    fn poll_event(&mut self) -> Option<Event>;

    /// Calls `each` with the CAN-IDs that the node listens to, if they may have changed since the
    /// last call.
    fn each_wanted_id(&mut self, each: &mut dyn FnMut(CanId));

    /// Carries out what is due, if anything is.
    fn catch_up(&mut self, now: Instant) {
        if self.poll_timeout().is_some_and(|at| at <= now) {
            self.handle_timeout(now);
        }
    }
}

impl<D: Device, A: Application, S: Storage> Owner for Node<D, A, S> {
    fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        self.handle_frame(now, frame);
    }

    fn handle_timeout(&mut self, now: Instant) {
        self.handle_timeout(now);
    }

    fn handle_change(&mut self, now: Instant) {
        self.handle_change(now);
    }

    fn handle_bus(&mut self, now: Instant, event: BusEvent) {
        self.handle_bus(now, event);
    }

    fn is_bus_off(&self) -> bool {
        self.is_bus_off()
    }

    fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        self.poll_transmit(now)
    }

    fn poll_timeout(&self) -> Option<Instant> {
        self.poll_timeout()
    }

    fn poll_event(&mut self) -> Option<Event> {
        self.poll_event()
    }

    fn each_wanted_id(&mut self, each: &mut dyn FnMut(CanId)) {
        if let Some(ids) = self.poll_wanted_ids() {
            ids.for_each(each);
        }
    }
}
