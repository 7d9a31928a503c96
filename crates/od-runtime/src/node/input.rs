//! Inputs of the node: frames, time, and changes on the side of the device.

use od_model::Address;
use od_wire::emcy::Emcy;
use od_wire::nmt::{self, Command, State};
use od_wire::{AbortCode, CanId, Frame, Instant};

use super::controller::Mute;
use super::{Machines, Node};
use crate::application::{Application, Reset};
use crate::device::Device;
use crate::emcy::{PDO_LENGTH, RPDO_TIMEOUT, SYNC_LENGTH};
use crate::listening::Service;
use crate::lss::{self, Action};
use crate::objects::Objects;
use crate::rooms::{Rooms, Slices};
use crate::storage::Storage;

impl<D: Device, A: Application, S: Storage> Node<D, A, S> {
    /// Handles a frame that was received.
    pub fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        let service = self.machines.service(frame);
        // Most frames are for other nodes. Live values are checked when any frame comes.
        if service.is_none() && !self.machines.watches_live {
            self.machines.now = self.machines.now.max(now);
            return;
        }
        self.call(now, |node, objects| match service {
            Some(service) => node.serve(objects, service, frame),
            None => node.finish(objects),
        });
    }

    /// Carries out what is due at `now`, the moment of [`poll_timeout`](Self::poll_timeout) or a
    /// later one.
    pub fn handle_timeout(&mut self, now: Instant) {
        let node = &mut self.machines;
        if now.max(node.now) < node.next && !node.watches_live {
            node.now = node.now.max(now);
            return;
        }
        self.call(now, |node, objects| node.handle_due(objects));
    }

    /// Tells the application that the world outside the bus changed (shaft, faults, switches).
    pub fn handle_change(&mut self, now: Instant) {
        self.call(now, |node, objects| {
            if node.state == State::Initialising {
                return;
            }
            node.tick(objects);
            node.wake_servers(objects, true);
            node.finish(objects);
        });
    }

    /// Sets a value as the device itself does. Limits and rules are those of a master's download,
    /// but the access type is ignored, so read-only objects change, too. Event-driven TPDOs with
    /// the value are sent.
    ///
    /// # Errors
    /// The abort code of the download; `ReadOnly` for an object without memory for its value
    /// (const), `DeviceState` without power and before the boot-up message.
    pub fn set_value(
        &mut self,
        now: Instant,
        address: Address,
        bytes: &[u8],
    ) -> Result<(), AbortCode> {
        let result = self.call(now, |node, objects| {
            if node.state == State::Initialising {
                return Err(AbortCode::DeviceState);
            }
            objects.set(address, bytes)?;
            node.finish(objects);
            Ok(())
        });
        result.unwrap_or(Err(AbortCode::DeviceState))
    }

    /// Reports an error, as [`Signals::raise`](crate::Signals::raise) does. Returns `false` if it
    /// is active already, without power, and before the boot-up message.
    pub fn raise(&mut self, now: Instant, error: Emcy) -> bool {
        self.change_error(now, error, true)
    }

    /// Reports the end of the error with this code and these bits of 1001h. Returns `false` if it is
    /// not active.
    pub fn clear(&mut self, now: Instant, error: Emcy) -> bool {
        self.change_error(now, error, false)
    }

    fn change_error(&mut self, now: Instant, error: Emcy, comes: bool) -> bool {
        let changed = self.call(now, |node, objects| {
            if node.state == State::Initialising || node.emcy().is_active(error) == comes {
                return false;
            }
            let Emcy {
                code,
                register,
                info,
            } = error;
            if comes {
                objects.outbox.signals.raise(error);
            } else {
                objects.outbox.signals.clear_one(code, register, info);
            }
            node.finish(objects);
            true
        });
        changed == Some(true)
    }
}

impl<D: Device> Machines<D> {
    /// Passes a frame to its service, if the NMT state allows the service (CiA 301, table 37).
    fn serve(&mut self, objects: &mut Objects<'_, D>, service: Service, frame: &Frame) {
        // Before its boot-up message a node without a node ID serves only LSS.
        if self.state == State::Initialising || self.mute.is_some() {
            if service == Service::Lss && self.is_unconfigured() {
                self.handle_lss(objects, frame);
            }
            return;
        }
        let is_operational = self.state == State::Operational;
        match service {
            Service::Nmt => return self.handle_nmt(objects, frame),
            Service::Lss => return self.handle_lss(objects, frame),
            Service::Guarding => self.handle_guarding(objects),
            Service::Heartbeat => self.handle_heartbeat(objects, frame),
            _ if self.state == State::Stopped => return,
            Service::Sdo(at) => self.handle_sdo(objects, at.into(), frame),
            Service::Time => self.handle_time(objects, frame),
            _ if !is_operational => return,
            Service::Sync => self.handle_sync(objects, frame),
            Service::Rpdo(number) => self.handle_rpdo(objects, number, frame),
            Service::TpdoRequest(number) => self.handle_tpdo_request(objects, number),
        }
        self.finish(objects);
    }

    /// Carries out what is due, each service in a fixed order.
    fn handle_due(&mut self, objects: &mut Objects<'_, D>) {
        let now = objects.now;
        if self.boot_at.is_due(now) {
            self.boot_up(objects);
        }
        if D::LSS && self.mute.is_some_and(|mute| mute.until <= now) {
            self.end_mute();
        }
        if self.heartbeat.handle_timeout(now) {
            self.push_error_control(self.state as u8);
        }
        self.wake_servers(objects, false);
        if D::GUARDING || D::CONSUMER {
            self.monitor().handle_timeout(now);
            self.poll_monitor(objects);
        }
        if objects.save_due().is_due(now) {
            self.end_save(objects);
        }
        if self.tick_at.is_due(now) {
            self.tick(objects);
        }
        self.produce_sync(objects);
        if self.state == State::Operational {
            self.each_tpdo(|pdo, mapped| pdo.handle_timeout(objects, mapped));
            if D::DEADLINES {
                self.watch_rpdos(objects);
            }
        }
        self.finish(objects);
        self.next = self.timers(objects.save_due()).moment();
    }

    /// Handles an NMT command (CiA 301, chapter 7.2.8.3.1).
    fn handle_nmt(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        let Some(nmt::Repr { command, node }) = nmt::Repr::parse(frame.data()) else {
            return;
        };
        if node != 0 && node != self.node_id.raw() {
            return;
        }
        match command {
            Command::Start => {
                self.enter(objects, State::Operational);
                self.react_to_active(objects);
            }
            Command::Stop => self.enter(objects, State::Stopped),
            Command::EnterPreOperational => self.enter(objects, State::PreOperational),
            Command::ResetNode => return self.reset(objects, Reset::Node),
            Command::ResetCommunication => return self.reset(objects, Reset::Communication),
        }
        self.finish(objects);
    }

    /// Handles an LSS command (CiA 305), if the device supports LSS and the state allows it.
    fn handle_lss(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        let Some(profile) = objects.profile.lss.as_ref().filter(|_| D::LSS) else {
            return;
        };
        if profile.stopped_only && self.state != State::Stopped {
            return;
        }
        let active = if self.unconfigured {
            lss::UNCONFIGURED
        } else {
            self.node_id.raw()
        };
        let Some(slave) = self.rooms.all_mut().lss.first_mut() else {
            return;
        };
        let action = slave.handle(objects, profile, active, frame.data());
        let is_ready = slave.is_ready();
        match action {
            Action::Answer(None) => {}
            Action::Answer(Some(response)) => {
                let id = CanId::standard(od_wire::lss::SLAVE);
                self.push(Frame::full(id, response.emit()));
            }
            Action::Activate { delay_ms, bit_rate } => {
                let silence_ms = if profile.second_delay { delay_ms } else { 0 };
                self.mute = Some(Mute {
                    until: self.now.plus_millis(delay_ms.into()),
                    bit_rate: u16::from(bit_rate) + 1,
                    silence_ms,
                });
            }
        }
        self.finish(objects);
        // The master has assigned a node ID: the node boots with it.
        if self.unconfigured && is_ready {
            self.reset(objects, Reset::Communication);
        }
    }

    /// Handles a guarding request of a master (CiA 301, chapter 7.2.8.3.2.1).
    fn handle_guarding(&mut self, objects: &mut Objects<'_, D>) {
        let (state, now) = (self.state, objects.now);
        if let Some(response) = self.monitor().guard(state, now) {
            self.push_error_control(response);
        }
        self.poll_monitor(objects);
    }

    /// Handles a heartbeat or boot-up message of a monitored node (CiA 301, chapter 7.2.8.3.2.2).
    fn handle_heartbeat(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        let node = (frame.id().raw() & 0x7F) as u8;
        self.monitor().heartbeat(node, objects.now);
        self.poll_monitor(objects);
    }

    /// Handles a remote frame that requests a TPDO (CiA 301, chapter 7.2.2.5.2).
    fn handle_tpdo_request(&mut self, objects: &mut Objects<'_, D>, number: u16) {
        let rooms = self.rooms.all_mut();
        if let Some(pdo) = rooms.tpdos.get_mut(usize::from(number))
            && let Some(frame) = pdo.request(objects, rooms.mapped)
        {
            rooms.frames.push(frame);
        }
    }

    /// Handles a SYNC message, with or without a counter of one byte (CiA 301, chapter 7.2.5; table
    /// 26, code 8240h).
    fn handle_sync(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        if D::SYNC_LENGTH && objects.profile.errors.watches_sync_length {
            if self.sync_length.is_right(frame.data().len()) {
                self.end_error(objects, SYNC_LENGTH);
            } else {
                objects
                    .outbox
                    .signals
                    .raise(communication_error(SYNC_LENGTH));
            }
        }
        match frame.data() {
            [] => self.sync(objects, None),
            [counter] => self.sync(objects, Some(*counter)),
            _ => {}
        }
    }

    /// Carries out a SYNC of another node or of this one.
    pub(super) fn sync(&mut self, objects: &mut Objects<'_, D>, counter: Option<u8>) {
        let Slices {
            tpdos,
            rpdos,
            mapped,
            ..
        } = self.rooms.all_mut();
        for pdo in rpdos {
            pdo.sync(objects, mapped);
        }
        for pdo in tpdos {
            pdo.sync(objects, mapped, counter);
        }
    }

    /// Handles the frame of an RPDO, also for the following RPDOs with the same CAN-ID (CiA 301,
    /// chapter 7.2.2.5.1).
    fn handle_rpdo(&mut self, objects: &mut Objects<'_, D>, first: u16, frame: &Frame) {
        for at in usize::from(first).. {
            let rooms = self.rooms.all_mut();
            let Some(pdo) = rooms.rpdos.get_mut(at) else {
                break;
            };
            if pdo.received_by() != Some(frame.id()) {
                continue;
            }
            if pdo.receive(objects, rooms.mapped, frame) {
                self.end_error(objects, PDO_LENGTH);
            } else {
                objects
                    .outbox
                    .signals
                    .raise(communication_error(PDO_LENGTH));
            }
        }
        // The error ends when all RPDOs that were late have arrived again.
        if D::DEADLINES && !self.rooms.all().rpdos.iter().any(|pdo| pdo.is_late()) {
            self.end_error(objects, RPDO_TIMEOUT);
        }
    }

    /// Reports RPDOs whose next frame is late (CiA 301, object 1400h, sub-index 5; table 26, code
    /// 8250h).
    fn watch_rpdos(&mut self, objects: &mut Objects<'_, D>) {
        for pdo in self.rooms.all_mut().rpdos {
            if pdo.handle_timeout(objects.now) {
                objects
                    .outbox
                    .signals
                    .raise(communication_error(RPDO_TIMEOUT));
            }
        }
    }

    /// Ends an error of the communication, if it is active.
    pub(super) fn end_error(&self, objects: &mut Objects<'_, D>, code: u16) {
        if self
            .rooms
            .all()
            .errors
            .iter()
            .any(|error| error.code == code)
        {
            objects.outbox.signals.clear(code, [0; 5]);
        }
    }
}

/// Error of the communication: sets bits 0 and 4 of 1001h.
const fn communication_error(code: u16) -> Emcy {
    Emcy {
        code,
        register: 0x11,
        info: [0; 5],
    }
}
