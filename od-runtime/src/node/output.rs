//! Outputs of the node: frames, the next deadline, events.

use od_wire::nmt::State;
use od_wire::{Frame, Instant, NodeId};

use super::ear::{Ear, Quick};
use super::{Event, Machines, Node, pending};
use crate::application::Context;
use crate::deadline::Deadline;
use crate::device::{Device, ROOMY};
use crate::extras::Extras;
use crate::lent::Lent;
use crate::objects::Objects;
use crate::objects::outbox::Outbox;
use crate::pdo;
use crate::rooms::{Room, Rooms};
use crate::store::Store;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// Returns whether [`poll_transmit`](Self::poll_transmit) may have a frame. If not, a host need not
    /// put its device together for the call.
    #[inline]
    pub const fn may_transmit(&self) -> bool {
        self.machines.pending != 0
    }

    /// Returns the next frame to send; `None` when all are out. `now` is the moment of the
    /// input before it.
    #[inline]
    pub fn poll_transmit(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        if node.pending == 0 {
            return None;
        }
        // While the node is mute, something else waits, too.
        let is_answer = match ROOMY {
            true => node.pending == pending::ANSWER,
            false => node.pending & pending::ANSWER != 0 && node.mute.is_none(),
        };
        if is_answer {
            node.pending &= !pending::ANSWER;
            return Some(node.response(bytes(node.answer)));
        }
        match ROOMY {
            true => self.poll_waiting(device, now),
            false => self.poll_seldom(device, now),
        }
    }

    /// As [`poll_waiting`](Self::poll_waiting), where several kinds of frames may wait.
    #[inline(never)]
    pub(super) fn poll_seldom(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        if node.mute.is_some() {
            node.discard_frames();
            return None;
        }
        let now = now.max(node.now);
        if ROOMY && node.pending & pending::ANSWER != 0 {
            node.pending &= !pending::ANSWER;
            return Some(node.response(bytes(node.answer)));
        }
        if let Some(frame) = Room::queue_mut(&mut node.out).pop() {
            return Some(frame);
        }
        node.pend_marks();
        if node.pending & pending::PDO != 0
            && let Some(frame) = self.poll_pdo(device, now)
        {
            return Some(frame);
        }
        let node = &mut self.machines;
        if node.pending & pending::OTHER == 0 {
            return None;
        }
        if node.emcy.is_waiting() || D::BLOCK && node.sdo.is_sending() || node.is_server_sending() {
            return self.poll_services(device, now);
        }
        if node.next == Instant::ZERO {
            node.find_next();
        }
        node.pending &= !pending::OTHER;
        None
    }

    /// Returns the next PDO that is ready. `now` is not before the time of the node.
    #[inline(never)]
    fn poll_pdo(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        if device.values.len() < device.dictionary.store_len() {
            return None;
        }
        // One that the inhibit time holds back stays pending.
        let (mut ready, mut others) = (None, false);
        for (at, pdo) in node.tpdos().iter().enumerate() {
            if pdo.is_pending() {
                match ready {
                    None if pdo.is_ready::<D>(now) => ready = Some(at),
                    _ => others = true,
                }
            }
        }
        if !others {
            node.pending &= !pending::PDO;
        }
        self.send_pdo(device, now, ready?)
    }

    /// Returns the frame of the TPDO at a position. `now` is not before the time of the node.
    #[cfg_attr(not(target_os = "none"), inline(never))]
    pub(super) fn send_pdo(
        &mut self,
        device: &mut Lent<'_>,
        now: Instant,
        at: usize,
    ) -> Option<Frame> {
        let node = &mut self.machines;
        let pdo = node.tpdo.get_mut(at)?;
        if pdo.is_live() {
            let outbox = Room::outbox(&mut self.outbox);
            refresh::<D, _>(pdo, device, node.node_id, now, outbox);
            if !outbox.is_empty() {
                // What the application has to say of the values comes with the next call.
                node.next = Instant::ZERO;
                node.pending |= pending::OTHER;
                node.ear.codes = Ear::EVERYTHING;
                node.quick = Quick::NONE;
            }
        }
        pdo.send::<D>(&device.dictionary, device.values, node.node_id, now)
    }

    /// Returns the next frame that no request asked for but a PDO: EMCY message, block segment. `now` as
    /// for PDOs.
    #[inline(never)]
    fn poll_services(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        if node.sends_emcy() {
            let store = Store::new(&device.dictionary, device.values, node.node_id).ok()?;
            let frame = node.emcy.poll::<D>(&store, now);
            if frame.is_some() {
                return frame;
            }
        }
        if D::BLOCK {
            let (outbox, saving) = (
                Room::outbox(&mut self.outbox),
                self.saves.all_mut().first_mut(),
            );
            let mut objects = device.objects(node.node_id, now, outbox, saving);
            let objects: &mut Objects<'_, D> = objects.as_mut()?;
            node.next = Instant::ZERO;
            if let Some(segment) = node.sdo.poll(objects) {
                return Some(node.response(segment));
            }
            if D::SERVERS {
                return node.poll_servers(objects);
            }
        }
        None
    }

    /// Time when [`handle_timeout`](Self::handle_timeout) is to be called next; `None` if only a
    /// frame or a change can give the node something to do.
    #[inline]
    pub fn poll_timeout(&self) -> Option<Instant> {
        let node = &self.machines;
        match node.pending {
            // Nothing waits, so these are the only deadlines.
            0 if node.next != Instant::ZERO => {
                let next = Deadline::at(node.next);
                next.is_set().then(|| next.moment())
            }
            _ => node.deadline(),
        }
    }

    /// Returns the oldest pending event. The queue holds 16; while it is full, new events are
    /// dropped.
    pub fn poll_event(&mut self) -> Option<Event> {
        Room::queue_mut(&mut self.machines.events).pop()
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// Sends an SDO response, after all that waits already.
    #[cfg_attr(target_os = "none", inline(never))]
    #[cfg_attr(not(target_os = "none"), inline)]
    pub(super) fn answer(&mut self, answer: [u8; 8]) {
        if self.pending & pending::ANSWER == 0 && self.out.is_empty() {
            self.answer = words(answer);
            self.pending |= pending::ANSWER;
        } else {
            self.push_answer(answer);
        }
    }

    #[cold]
    fn push_answer(&mut self, answer: [u8; 8]) {
        let response = self.response(answer);
        self.push(response);
    }

    #[inline]
    fn response(&self, data: [u8; 8]) -> Frame {
        Frame::full(self.node_id.plus(0x580), data)
    }

    /// Boot-up message, heartbeat and answer to guarding: one byte under 700h + node ID.
    #[inline(never)]
    pub(super) fn push_error_control(&mut self, byte: u8) {
        self.push(Frame::of(self.node_id.plus(0x700), &[byte]));
    }

    /// Discards the frames that wait.
    pub(super) fn discard_frames(&mut self) {
        self.out.clear();
        self.pending &= !pending::ANSWER;
    }

    /// EMCYs wait for the boot-up message, and for the end of Stopped.
    pub(super) fn sends_emcy(&self) -> bool {
        matches!(self.state, State::PreOperational | State::Operational) && self.mute.is_none()
    }

    #[inline(never)]
    fn deadline(&self) -> Option<Instant> {
        if !self.powered {
            return None;
        }
        let mut first = match self.next {
            Instant::ZERO => self.timers(),
            next => Deadline::at(next),
        };
        if self.sends_emcy() {
            first = first.or(self.emcy.deadline());
        }
        if self.state == State::Operational && self.mute.is_none() {
            let mut marks = self.pending & pending::MARKS;
            for pdo in self.tpdos() {
                first = first.or(pdo.ready_at(ROOMY && marks & pending::FIRST_MARK != 0));
                marks >>= 1;
            }
        }
        // A host that came to the end of time would be called back there for ever.
        first.is_set().then(|| first.moment())
    }

    /// The first deadline of all that is not a frame that waits.
    #[inline(never)]
    pub(super) fn timers(&self) -> Deadline {
        let mut first = self.timers_but_pdos();
        if self.state == State::Operational && self.mute.is_none() {
            for pdo in self.tpdos() {
                first = first.or(pdo.deadline::<D>());
            }
        }
        first
    }

    /// The same without the event timers of TPDOs.
    #[inline(always)]
    pub(super) fn timers_but_pdos(&self) -> Deadline {
        let mut first = self.tick_at.or(self.heartbeat.deadline());
        if Self::BOOTS_LATE {
            first = first.or(self.boot_at);
        }
        if Self::HAS_MONITOR {
            first = first.or(self.monitor.deadline::<D>());
        }
        if D::LSS
            && let Some(mute) = self.mute
        {
            first = first.or(Deadline::at(mute.until));
        }
        if D::BLOCK || D::STREAMS {
            first = first.or(self.sdo.deadline());
        }
        if D::SYNC_PRODUCER {
            first = first.or(Deadline::of(self.sync_deadline()));
        }
        if D::SERVERS {
            first = first.or(self.servers_deadline());
        }
        for at in self.save_at.all() {
            first = first.or(*at);
        }
        first
    }
}

/// Has the application bring the live values of a PDO up to date.
#[cfg_attr(target_os = "none", inline(never))]
fn refresh<D: Device, R: Rooms>(
    pdo: &pdo::Tpdo<R>,
    device: &mut Lent<'_>,
    node_id: NodeId,
    now: Instant,
    outbox: &mut Outbox,
) {
    if let Ok(mut store) = Store::new(&device.dictionary, device.values, node_id) {
        let mut context = Context {
            store: &mut store,
            now,
            signals: &mut outbox.signals,
        };
        pdo.refresh::<D>(device.application, &mut context, outbox.live);
    }
}

/// The data of a frame as two words, and back.
#[inline(always)]
pub(super) fn words(data: [u8; 8]) -> [u32; 2] {
    let data = u64::from_le_bytes(data);
    [data as u32, (data >> 32) as u32]
}

#[inline(always)]
fn bytes([low, high]: [u32; 2]) -> [u8; 8] {
    (u64::from(high) << 32 | u64::from(low)).to_le_bytes()
}
