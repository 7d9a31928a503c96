//! Outputs of the node: frames, the next deadline, events.

use od_wire::nmt::State;
use od_wire::{Frame, Instant};

use super::{Event, Machines, Node};
use crate::application::Application;
use crate::deadline::Deadline;
use crate::device::Device;
use crate::error_control;
use crate::objects::Objects;
use crate::rooms::{Rooms, Saving, Shared, Slices, Values};
use crate::storage::Storage;

impl<D: Device, A: Application, S: Storage> Node<D, A, S> {
    /// Returns the next frame to send, or `None` when all are sent. `now` is the time of the last
    /// input.
    pub fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        if node.idle {
            return None;
        }
        if node.mute.is_some() {
            node.rooms.all_mut().frames.clear();
            return None;
        }
        // Responses come first; they need no value of the device.
        if let Some(frame) = node.rooms.all_mut().frames.pop() {
            return Some(frame);
        }
        if !node.may_transmit() {
            node.idle = true;
            return None;
        }
        let next = node.next;
        let frame = self.call(now, |node, objects| {
            let frame = node.next_frame(objects);
            if !objects.outbox.is_empty() {
                // The application brought live values up to date, and made requests.
                node.finish(objects);
            } else if frame.is_none() {
                node.next = next;
            }
            frame
        });
        frame.flatten()
    }
}

impl<D: Device, A, S> Node<D, A, S> {
    /// Returns whether [`poll_transmit`](Self::poll_transmit) may have a frame.
    pub const fn may_transmit(&self) -> bool {
        !self.machines.idle
    }

    /// Returns the time for the next call of [`handle_timeout`](Self::handle_timeout); `None`: the
    /// node waits for a frame or a change.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let node = &self.machines;
        if !node.powered {
            return None;
        }
        let mut first = match node.next {
            Instant::ZERO => node.timers(save_due(&self.values)),
            next => Deadline::at(next),
        };
        let Shared {
            tpdos, messages, ..
        } = node.rooms.all();
        if node.sends_emcy() {
            first = first.or(node.emcy.deadline(messages));
        }
        if node.sends_pdos() {
            first = tpdos
                .iter()
                .fold(first, |first, pdo| first.or(pdo.ready_at()));
        }
        // `None` if no deadline is set: its moment is the last instant, at which the host would
        // call without end.
        first.is_set().then(|| first.moment())
    }

    /// Returns the oldest pending event. The queue holds 16; while it is full, new events are
    /// dropped.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.machines.rooms.all_mut().events.pop()
    }
}

impl<D: Device> Machines<D> {
    /// Returns whether a frame that is not in the queue may wait.
    fn may_transmit(&self) -> bool {
        let Shared {
            tpdos,
            messages,
            servers,
            ..
        } = self.rooms.all();
        self.powered
            && (!messages.is_empty()
                || tpdos.iter().any(|pdo| pdo.is_pending())
                || D::BLOCK && servers.iter().any(|server| server.is_sending()))
    }

    /// Makes the next frame that waits for room: a PDO, an EMCY message, or a segment of a block
    /// upload.
    fn next_frame(&mut self, objects: &mut Objects<'_, D>) -> Option<Frame> {
        let Slices { tpdos, mapped, .. } = self.rooms.all_mut();
        if let Some(pdo) = tpdos.iter_mut().find(|pdo| pdo.is_ready(objects.now)) {
            return Some(pdo.send(objects, mapped));
        }
        if self.sends_emcy() {
            let now = objects.now;
            let frame = self.emcy().poll::<D>(&objects.store, now);
            if frame.is_some() {
                return frame;
            }
        }
        self.next_segment(objects)
    }

    /// Queues a boot-up message, a heartbeat or a response to guarding: one byte with CAN-ID 700h +
    /// node ID.
    pub(super) fn push_error_control(&mut self, byte: u8) {
        self.push(Frame::of(self.node_id.plus(0x700), &[byte]));
    }

    /// Returns whether EMCY messages can be sent: after the boot-up message and not in Stopped.
    pub(super) fn sends_emcy(&self) -> bool {
        matches!(self.state, State::PreOperational | State::Operational) && self.mute.is_none()
    }

    /// Returns whether PDOs can be sent: in Operational.
    fn sends_pdos(&self) -> bool {
        self.state == State::Operational && self.mute.is_none()
    }

    /// Returns the earliest deadline, except those of waiting frames.
    pub(super) fn timers(&self, save_due: Deadline) -> Deadline {
        let Shared {
            tpdos,
            rpdos,
            servers,
            watches,
            guards,
            clocks,
            ..
        } = self.rooms.all();
        let mut first = self
            .tick_at
            .or(self.heartbeat.deadline())
            .or(self.boot_at)
            .or(save_due)
            .or(error_control::deadline(guards, watches));
        if let Some(mute) = self.mute {
            first = first.or(Deadline::at(mute.until));
        }
        for server in servers {
            first = first.or(server.deadline());
        }
        for clocks in clocks {
            first = first.or(Deadline::of(clocks.sync.deadline()));
        }
        if self.sends_pdos() {
            first = tpdos
                .iter()
                .fold(first, |first, pdo| first.or(pdo.deadline()));
            first = rpdos
                .iter()
                .fold(first, |first, pdo| first.or(pdo.deadline()));
        }
        first
    }
}

/// Returns the time when the current save is complete.
fn save_due(values: &impl Values) -> Deadline {
    values.saving().map_or(Deadline::NEVER, Saving::due)
}
