//! Outputs of the node: frames, the next deadline, events.

use od_wire::nmt::State;
use od_wire::{Frame, Instant};

use super::{Event, Machines, Node};
use crate::device::Device;
use crate::extras::Extras;
use crate::lent::Lent;
use crate::objects::Objects;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// Returns the next frame to send; `None` when all are out. `now` is the moment of the
    /// input before it.
    #[inline]
    pub fn poll_transmit(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        if node.mute.is_some() {
            node.discard_frames();
            return None;
        }
        if let Some(answer) = node.answer.take() {
            return Some(node.response(answer.to_le_bytes()));
        }
        if let Some(frame) = node.out.pop() {
            return Some(frame);
        }
        if node.pdo_pending
            || node.emcy.deadline().is_some()
            || D::BLOCK && node.sdo.is_sending()
            || node.is_server_sending()
        {
            return self.poll_services(device, now);
        }
        None
    }

    /// Returns the next frame that no request asked for: PDO, EMCY message, block segment.
    #[inline(never)]
    fn poll_services(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        let now = now.max(node.now);
        let mut objects: Objects<'_, D> = device.objects(node.node_id, now, &mut self.outbox)?;
        if node.pdo_pending {
            let mut pdos = node.tpdos().iter_mut();
            let frame = pdos.find_map(|pdo| pdo.poll(&mut objects));
            // Those before the one that was sent are not ready.
            node.pdo_pending = pdos.any(|pdo| pdo.is_ready(now));
            if frame.is_some() {
                return frame;
            }
        }
        if node.sends_emcy() {
            let frame = node.emcy.poll(&objects.store, now);
            if frame.is_some() {
                return frame;
            }
        }
        if D::BLOCK {
            if let Some(segment) = node.sdo.poll(&mut objects) {
                return Some(node.response(segment));
            }
            if D::SERVERS {
                return node.poll_servers(&mut objects);
            }
        }
        None
    }

    /// When [`handle_timeout`](Self::handle_timeout) is to be called next; `None` if only a
    /// frame or a change can give the node something to do.
    #[inline]
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.machines.deadline()
    }

    /// Returns the oldest pending event. The queue holds 16; while it is full, new events are
    /// dropped.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.machines.events.pop()
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// Sends an SDO response, after all that waits already.
    #[inline]
    pub(super) fn answer(&mut self, answer: [u8; 8]) {
        if self.answer.is_none() && self.out.is_empty() {
            self.answer = Some(u64::from_le_bytes(answer));
        } else {
            let response = self.response(answer);
            self.out.push(response);
        }
    }

    #[inline]
    fn response(&self, data: [u8; 8]) -> Frame {
        Frame::full(self.node_id.plus(0x580), data)
    }

    /// Boot-up message, heartbeat and answer to guarding: one byte under 700h + node ID.
    pub(super) fn push_error_control(&mut self, byte: u8) {
        self.out.push(Frame::of(self.node_id.plus(0x700), &[byte]));
    }

    /// Discards the frames that wait.
    pub(super) fn discard_frames(&mut self) {
        self.out.clear();
        self.answer = None;
    }

    /// EMCYs wait for the boot-up message, and for the end of Stopped.
    pub(super) fn sends_emcy(&self) -> bool {
        matches!(self.state, State::PreOperational | State::Operational) && self.mute.is_none()
    }

    fn deadline(&self) -> Option<Instant> {
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
        if Self::HAS_MONITOR {
            consider(self.monitor.deadline::<D>());
        }
        consider(self.mute.map(|mute| mute.until));
        if D::BLOCK || D::STREAMS {
            consider(self.sdo.deadline());
        }
        if D::SYNC_PRODUCER {
            consider(self.sync_deadline());
        }
        if D::SERVERS {
            consider(self.servers_deadline());
        }
        if D::STORAGE {
            consider(self.save_at);
        }
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
}
