//! Inputs of the node: frames, time, and changes outside the bus.

use od_wire::emcy::Emcy;
use od_wire::nmt::{self, Command, State};
use od_wire::{CanId, Frame, Instant};

use super::controller::Mute;
use super::{Machines, Node, pending};
use crate::application::Reset;
use crate::device::{Device, ROOMY};
use crate::emcy::PDO_LENGTH;
use crate::extras::Extras;
use crate::lent::Lent;
use crate::lss::{self, Action};
use crate::objects::Objects;
use crate::pdo::Received;
use crate::rooms::Room;

/// The CAN-ID of NMT commands.
const NMT: CanId = CanId::standard(0);

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// Handles a frame that was received.
    #[inline]
    pub fn handle_frame(&mut self, device: &mut Lent<'_>, now: Instant, frame: &Frame) {
        let node = &mut self.machines;
        let id = frame.id();
        if ROOMY && id == node.ear.sdo {
            node.now = node.now.max(now);
            self.handle_request(device, frame);
        } else if ROOMY && id == node.ear.sync {
            node.now = node.now.max(now);
            self.handle_count(device, frame);
        } else if node.ear.hears(id) {
            node.now = node.now.max(now);
            self.receive(device, frame);
        }
    }

    /// A frame that is for this node: what comes all day, or any other.
    #[inline(never)]
    fn receive(&mut self, device: &mut Lent<'_>, frame: &Frame) {
        let ear = &self.machines.ear;
        if !ROOMY && frame.id() == ear.sdo {
            self.handle_request(device, frame);
        } else if !ROOMY && frame.id() == ear.sync {
            self.handle_count(device, frame);
        } else {
            self.handle_seldom(device, frame);
        }
    }

    /// Any frame.
    #[inline(never)]
    pub(super) fn handle_seldom(&mut self, device: &mut Lent<'_>, frame: &Frame) {
        let now = self.machines.now;
        let mut open = self.open(device, now);
        let Some((node, objects)) = &mut open else {
            return;
        };
        if node.state == State::Initialising || node.mute.is_some() {
            return node.handle_unconfigured(objects, frame);
        }
        let id = frame.id();
        if id == NMT {
            if !frame.is_remote() {
                node.handle_nmt(objects, frame);
            }
            return;
        }
        let is_error_control = Machines::<D, PDO, SDO, X>::HAS_MONITOR
            && id.raw() & 0x780 == 0x700
            && !id.is_extended();
        if D::LSS && id == CanId::standard(od_wire::lss::MASTER) {
            node.handle_lss(objects, frame);
            return;
        }
        if node.state == State::Stopped && !is_error_control {
            return;
        }
        if is_error_control {
            node.handle_error_control(frame, objects.now);
            node.poll_monitor(objects);
        } else if frame.is_remote() {
            node.handle_remote(objects, frame);
        } else if id == node.node_id.plus(0x600) {
            if D::SERVERS && node.refuses(objects, frame) {
            } else {
                node.ask(objects, frame.bytes(), frame.dlc());
            }
        } else if D::SERVERS && node.handle_server(objects, frame) {
        } else if D::TIME && node.time_id() == Some(id) {
            node.handle_time(objects, frame);
        } else if node.state != State::Operational {
            return;
        } else if Some(id) == node.sync_id {
            node.handle_sync(objects, frame);
        } else if D::RPDOS {
            node.handle_rpdo(objects, frame);
        }
        node.finish(objects);
        node.reset_if_due(objects);
    }

    /// Does what is due by now; the moment is that of [`poll_timeout`](Self::poll_timeout), or
    /// later.
    #[inline]
    pub fn handle_timeout(&mut self, device: &mut Lent<'_>, now: Instant) {
        let node = &mut self.machines;
        node.now = node.now.max(now);
        if node.now < node.next && !node.watches_live {
            return;
        }
        if !(ROOMY && node.tick_pdos()) {
            self.handle_due(device, now);
        }
    }

    #[inline(never)]
    fn handle_due(&mut self, device: &mut Lent<'_>, now: Instant) {
        let mut open = self.open(device, now);
        let Some((node, objects)) = &mut open else {
            return;
        };
        let now = objects.now;
        if Machines::<D, PDO, SDO, X>::BOOTS_LATE && node.boot_at.is_due(now) {
            node.boot_up(objects);
        }
        if D::LSS && node.mute.is_some_and(|mute| mute.until <= now) {
            node.end_mute(objects);
        }
        if node.heartbeat.handle_timeout(now) {
            node.push_error_control(node.state as u8);
        }
        if (D::BLOCK || D::STREAMS)
            && let Some(answer) = node.sdo.handle_timeout(objects)
        {
            node.answer(answer);
        }
        node.wake_servers(objects, false);
        if Machines::<D, PDO, SDO, X>::HAS_MONITOR {
            node.monitor.handle_timeout::<D>(now);
            node.poll_monitor(objects);
        }
        if node.save_at.all().iter().any(|at| at.is_due(now)) {
            node.end_save(objects);
        }
        if node.tick_at.is_due(now) {
            node.tick(objects);
        }
        node.produce_sync(objects);
        if node.state == State::Operational {
            node.each_tpdo(|pdo| pdo.handle_timeout(objects));
        }
        node.finish(objects);
        node.reset_if_due(objects);
        node.find_next();
    }

    /// Tells the application that the world outside the bus changed (shaft, faults, switches).
    #[inline(never)]
    pub fn handle_change(&mut self, device: &mut Lent<'_>, now: Instant) {
        let mut open = self.open(device, now);
        let Some((node, objects)) = &mut open else {
            return;
        };
        if node.state == State::Initialising {
            return;
        }
        node.tick(objects);
        if let Some(answer) = node.sdo.handle_change(objects) {
            node.answer(answer);
        }
        node.wake_servers(objects, true);
        node.finish(objects);
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    #[inline(never)]
    fn handle_nmt(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        let Some(nmt::Repr { command, node }) = nmt::Repr::parse(frame.data()) else {
            return;
        };
        if node != 0 && node != self.node_id.raw() {
            return;
        }
        let state = match command {
            Command::Start => State::Operational,
            Command::Stop => State::Stopped,
            Command::EnterPreOperational => State::PreOperational,
            Command::ResetNode => return self.reset(objects, Reset::Node),
            Command::ResetCommunication => return self.reset(objects, Reset::Communication),
        };
        self.enter(objects, state);
        if state == State::Operational {
            self.react_to_lasting(objects);
        }
        self.finish(objects);
        self.reset_if_due(objects);
    }

    /// A frame before the boot-up message: a node without a node ID knows LSS only.
    #[cold]
    fn handle_unconfigured(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        if D::LSS && self.is_unconfigured() && frame.id() == CanId::standard(od_wire::lss::MASTER) {
            self.handle_lss(objects, frame);
        }
    }

    /// 7E5h: LSS, where the device has it and the state allows it.
    #[cold]
    fn handle_lss(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        let Some(profile) = objects.profile().lss else {
            return;
        };
        if frame.is_remote() || profile.stopped_only && self.state != State::Stopped {
            return;
        }
        let active = match self.unconfigured {
            true => lss::UNCONFIGURED,
            false => self.node_id.raw(),
        };
        let Some(slave) = self.lss.all_mut().first_mut() else {
            return;
        };
        match slave.handle(objects, &profile, active, frame.data()) {
            Action::Answer(None) => {}
            Action::Answer(Some(answer)) => {
                let id = CanId::standard(od_wire::lss::SLAVE);
                self.push(Frame::full(id, answer.emit()));
            }
            Action::Activate { delay_ms, bit_rate } => {
                let silence_ms = if profile.second_delay { delay_ms } else { 0 };
                self.mute = Some(Mute {
                    until: self.now.plus_millis(delay_ms.into()),
                    bit_rate: u16::from(bit_rate) + 1,
                    silence_ms,
                });
                self.listen(objects);
            }
        }
        self.finish(objects);
        if self.unconfigured && self.lss.all().iter().any(lss::Slave::is_ready) {
            self.reset(objects, Reset::Communication);
        }
    }

    /// 701h–77Fh: a master guards this node, or another node is alive.
    #[inline(never)]
    fn handle_error_control(&mut self, frame: &Frame, now: Instant) {
        let node = (frame.id().raw() & 0x7F) as u8;
        if !frame.is_remote() {
            if D::CONSUMER {
                self.monitor.heartbeat(node, now);
            }
        } else if D::GUARDING
            && node == self.node_id.raw()
            && let Some(answer) = self.monitor.guard(self.state, now)
        {
            self.push_error_control(answer);
        }
    }

    /// The error behaviour requested NMT reset node.
    #[inline]
    pub(super) fn reset_if_due(&mut self, objects: &mut Objects<'_, D>) {
        if D::BEHAVIOUR && self.reset_due {
            self.reset(objects, Reset::Node);
        }
    }

    #[inline(never)]
    fn handle_remote(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        if self.state != State::Operational {
            return;
        }
        let count = self.tpdo_count();
        let pdos = self.tpdo.get_mut(..count).unwrap_or_default();
        for pdo in pdos.iter_mut().filter(|pdo| pdo.answers(frame.id())) {
            if let Some(answer) = pdo.request(objects) {
                Room::queue_mut(&mut self.out).push(answer);
            }
            self.pending |= if pdo.is_pending() { pending::PDO } else { 0 };
        }
    }

    /// SYNC: with a counter of one byte or without.
    #[inline(never)]
    fn handle_sync(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        let counter = match frame.data() {
            [] => None,
            [counter] => Some(*counter),
            _ => return,
        };
        self.sync(objects, counter);
    }

    /// A SYNC, of another node or of this one.
    #[inline]
    pub(super) fn sync(&mut self, objects: &mut Objects<'_, D>, counter: Option<u8>) {
        if D::RPDOS {
            for pdo in self.rpdos_mut() {
                pdo.sync(objects);
            }
        }
        self.each_tpdo(|pdo| pdo.sync(objects, counter));
        self.expect_sync();
    }

    #[inline(never)]
    fn handle_rpdo(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        for pdo in self
            .rpdos_mut()
            .iter_mut()
            .filter(|pdo| pdo.takes(frame.id()))
        {
            match pdo.receive(objects, frame) {
                Received::Taken => objects.outbox.signals.clear(PDO_LENGTH, [0; 5]),
                Received::TooShort => {
                    objects.outbox.signals.raise(Emcy {
                        code: PDO_LENGTH,
                        register: 0x11,
                        info: [0; 5],
                    });
                }
            }
        }
        self.expect_sync();
    }
}
