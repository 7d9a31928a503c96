//! What comes in: frames and the passing of time.

use super::{Core, Event, bus};
use crate::application::Reset;
use crate::emcy::Error;
use crate::error_control;
use crate::lss::Action;
use crate::objects::{Device, Effect, Objects, Outbox};
use crate::pdo::Received;
use crate::storage::image;

use od_wire::nmt;
use od_wire::nmt::{Command, State};
use od_wire::{CanId, Frame, Instant};

/// Sub-index of 1010h, were it one, under which the device saves its own record.
const LIFE_RECORD: u8 = 0;

/// EMCY code of an RPDO that is shorter than its mapping (CiA 301, table 26).
pub(super) const PDO_LENGTH: u16 = 0x8210;

impl<const PDO: usize, const SDO: usize> Core<PDO, SDO> {
    #[inline]
    pub(super) fn handle_frame(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
        frame: &Frame,
    ) {
        let now = self.advance(now);
        if !self.powered || self.state == State::Initialising || self.mute.is_some() {
            return;
        }
        let id = frame.id();
        if id == CanId::standard(0) {
            if !frame.is_remote() {
                self.handle_nmt(device, outbox, now, frame);
            }
            return;
        }
        let is_error_control = id.raw() & 0x780 == 0x700 && !id.is_extended();
        if id == CanId::standard(od_wire::lss::MASTER) {
            self.handle_lss(device, outbox, frame);
            return;
        }
        if self.state == State::Stopped && !is_error_control {
            return;
        }
        let Some(mut objects) = device.objects(self.node_id, now, outbox) else {
            return;
        };
        if is_error_control {
            self.handle_error_control(frame, now);
            self.poll_monitor(&mut objects);
        } else if frame.is_remote() {
            self.handle_remote(&mut objects, frame);
        } else if id == self.node_id.plus(0x600) {
            if let Some(answer) = self.sdo.handle(&mut objects, frame.bytes(), frame.dlc()) {
                self.answer(answer);
            }
        } else if self.state == State::Operational {
            if id == self.sync_id {
                self.handle_sync(&mut objects, frame);
            } else {
                self.handle_rpdo(&mut objects, frame);
            }
        } else {
            return;
        }
        self.finish(&mut objects);
        self.reset_if_due(device, outbox, now);
    }

    #[inline]
    pub(super) fn handle_timeout(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) {
        let now = self.advance(now);
        if !self.powered {
            return;
        }
        if self.boot_at.is_some_and(|at| at <= now) {
            self.boot_up(device, outbox, now);
        }
        if self.mute.is_some_and(|mute| mute.until <= now) {
            self.end_mute();
        }
        if self.heartbeat.handle_timeout(now) {
            self.out
                .push(Frame::of(self.node_id.plus(0x700), &[self.state as u8]));
        }
        if let Some(abort) = self.sdo.handle_timeout(now) {
            self.answer(abort);
        }
        let Some(mut objects) = device.objects(self.node_id, now, outbox) else {
            return;
        };
        self.monitor.handle_timeout(now);
        self.poll_monitor(&mut objects);
        if self.save_at.is_some_and(|at| at <= now) {
            self.end_save(&mut objects);
        }
        if self.tick_at.is_some_and(|at| at <= now) {
            self.tick_at = objects.application(|application, context| application.tick(context));
        }
        if self.state == State::Operational {
            for pdo in self.tpdo.get_mut(..self.tpdo_count).unwrap_or_default() {
                pdo.handle_timeout(&mut objects);
                self.pdo_pending |= pdo.is_pending();
            }
        }
        self.finish(&mut objects);
        self.reset_if_due(device, outbox, now);
    }

    pub(super) fn handle_change(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) {
        let now = self.advance(now);
        if !self.powered || self.state == State::Initialising {
            return;
        }
        let Some(mut objects) = device.objects(self.node_id, now, outbox) else {
            return;
        };
        self.tick_at = objects.application(|application, context| application.tick(context));
        self.finish(&mut objects);
    }

    /// Time does not run backwards here, whatever the host's clock says.
    #[inline]
    pub(super) fn advance(&mut self, now: Instant) -> Instant {
        self.now = self.now.max(now);
        self.now
    }

    #[inline(never)]
    fn handle_nmt(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
        frame: &Frame,
    ) {
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
            Command::ResetNode => return self.reset(device, outbox, now, Reset::Node),
            Command::ResetCommunication => {
                return self.reset(device, outbox, now, Reset::Communication);
            }
        };
        if let Some(mut objects) = device.objects(self.node_id, now, outbox) {
            self.enter(&mut objects, state);
            if state == State::Operational {
                self.react_to_lasting(&mut objects);
            }
            self.finish(&mut objects);
        }
        self.reset_if_due(device, outbox, now);
    }

    /// 7E5h: LSS, where the device has it and the state allows it.
    #[cold]
    fn handle_lss(&mut self, device: &mut Device<'_>, outbox: &mut Outbox, frame: &Frame) {
        let Some(profile) = device.profile.lss else {
            return;
        };
        if frame.is_remote() || profile.stopped_only && self.state != State::Stopped {
            return;
        }
        let Some(mut objects) = device.objects(self.node_id, self.now, outbox) else {
            return;
        };
        match self.lss.handle(&mut objects, &profile, frame.data()) {
            Action::Answer(None) => {}
            Action::Answer(Some(answer)) => {
                self.out.push(Frame::full(
                    CanId::standard(od_wire::lss::SLAVE),
                    answer.emit(),
                ));
            }
            Action::Activate { delay_ms, bit_rate } => {
                let silence_ms = if profile.second_delay { delay_ms } else { 0 };
                self.mute = Some(bus::Mute {
                    until: self.now.plus_millis(delay_ms.into()),
                    bit_rate: Some(bit_rate),
                    silence_ms,
                });
            }
        }
        self.finish(&mut objects);
    }

    /// 701h–77Fh: a master guards this node, or another node is alive.
    #[inline(never)]
    fn handle_error_control(&mut self, frame: &Frame, now: Instant) {
        let node = (frame.id().raw() & 0x7F) as u8;
        if !frame.is_remote() {
            self.monitor.heartbeat(node, now);
        } else if node == self.node_id.raw()
            && let Some(answer) = self.monitor.guard(self.state, now)
        {
            self.out.push(Frame::of(frame.id(), &[answer]));
        }
    }

    /// The error behaviour asked for NMT reset node.
    #[inline]
    pub(super) fn reset_if_due(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) {
        if self.reset_due {
            self.reset(device, outbox, now, Reset::Node);
        }
    }

    #[inline(never)]
    fn handle_remote(&mut self, objects: &mut Objects<'_>, frame: &Frame) {
        if self.state != State::Operational {
            return;
        }
        let pdos = self.tpdo.get_mut(..self.tpdo_count).unwrap_or_default();
        for pdo in pdos.iter_mut().filter(|pdo| pdo.answers(frame.id())) {
            if let Some(answer) = pdo.request(objects) {
                self.out.push(answer);
            }
            self.pdo_pending |= pdo.is_pending();
        }
    }

    /// SYNC: with a counter of one byte or without.
    #[inline(never)]
    fn handle_sync(&mut self, objects: &mut Objects<'_>, frame: &Frame) {
        let counter = match frame.data() {
            [] => None,
            [counter] => Some(*counter),
            _ => return,
        };
        for pdo in self.rpdo.get_mut(..self.rpdo_count).unwrap_or_default() {
            pdo.sync(objects);
        }
        for pdo in self.tpdo.get_mut(..self.tpdo_count).unwrap_or_default() {
            pdo.sync(objects, counter);
            self.pdo_pending |= pdo.is_pending();
        }
    }

    #[inline(never)]
    fn handle_rpdo(&mut self, objects: &mut Objects<'_>, frame: &Frame) {
        let pdos = self.rpdo.get_mut(..self.rpdo_count).unwrap_or_default();
        for pdo in pdos.iter_mut().filter(|pdo| pdo.takes(frame.id())) {
            match pdo.receive(objects, frame) {
                Received::Taken => objects.outbox.signals.clear(PDO_LENGTH, [0; 5]),
                Received::TooShort => {
                    objects.outbox.signals.raise(Error {
                        code: PDO_LENGTH,
                        register: 0x11,
                        info: [0; 5],
                    });
                }
            }
        }
    }

    /// What follows from a call: services take changed objects over, errors go out,
    /// changed values make event-driven PDOs.
    #[inline]
    pub(super) fn finish(&mut self, objects: &mut Objects<'_>) {
        if !objects.outbox.is_empty() {
            self.empty_outbox(objects);
        }
        if self.watches_changes && self.state == State::Operational {
            for pdo in self.tpdo.get_mut(..self.tpdo_count).unwrap_or_default() {
                pdo.notice_change(objects);
                self.pdo_pending |= pdo.is_pending();
            }
        }
    }

    #[cold]
    fn empty_outbox(&mut self, objects: &mut Objects<'_>) {
        self.apply_effects(objects);
        if core::mem::take(&mut objects.outbox.signals.tick) {
            self.tick_at = objects.application(|application, context| application.tick(context));
        }
        // A save that goes on has the record in it.
        if core::mem::take(&mut objects.outbox.signals.keep) && objects.outbox.saving.is_none() {
            objects.refresh_life_record();
            let profile = &objects.profile.store;
            if image::save(objects.storage, &objects.store, profile, LIFE_RECORD).is_err() {
                self.events.push(Event::StorageDamaged);
            }
        }
        self.take_errors(objects);
    }

    /// A save that took its time is complete: its request is answered, and the one behind it.
    #[cold]
    fn end_save(&mut self, objects: &mut Objects<'_>) {
        self.save_at = None;
        let failed = (!objects.complete_save()).then_some(objects.profile.store.failed);
        let (answer, held) = self.sdo.finish(failed);
        if let Some(answer) = answer {
            self.answer(answer);
        }
        if let Some((data, dlc)) = held
            && let Some(answer) = self.sdo.handle(objects, &data, dlc)
        {
            self.answer(answer);
        }
    }

    fn apply_effects(&mut self, objects: &mut Objects<'_>) {
        let overflow = core::mem::take(&mut objects.outbox.overflow);
        let mut communication =
            core::mem::take(&mut objects.outbox.signals.reconfigure) || overflow;
        let mut heartbeat = overflow;
        let mut monitor = overflow;
        while let Some(effect) = objects.outbox.effects.pop() {
            self.events.push(match effect {
                Effect::Written(address) => {
                    heartbeat |= address.index == 0x1017 || switches(objects, address.index);
                    monitor |= error_control::is_configuration(address.index, objects.profile);
                    communication |= is_configuration(objects, address.index);
                    Event::Written(address)
                }
                Effect::Saved(sub) => Event::Saved(sub),
                Effect::NotSaved => Event::StorageDamaged,
                Effect::Saving => {
                    self.save_at = objects.outbox.saving.map(|saving| saving.due);
                    continue;
                }
                Effect::Restored(sub) => {
                    let at_once = objects.profile.store.restore == crate::profile::Restore::AtOnce;
                    communication |= at_once;
                    heartbeat |= at_once;
                    monitor |= at_once;
                    Event::Restored(sub)
                }
            });
        }
        if heartbeat {
            self.heartbeat
                .configure(&objects.store, objects.profile, objects.now);
        }
        if monitor {
            self.monitor.configure(&objects.store, objects.profile);
            self.poll_monitor(objects);
        }
        if communication {
            self.configure(objects);
        }
    }
}

/// Is it the object that switches from heartbeat to guarding?
fn switches(objects: &Objects<'_>, index: u16) -> bool {
    objects
        .profile
        .guarding_switch
        .is_some_and(|(switch, _)| switch == index)
}

/// Is it an object that SYNC or a PDO takes its configuration from?
fn is_configuration(objects: &Objects<'_>, index: u16) -> bool {
    let repeat = objects.profile.pdo.repeat_counter;
    let sync_only = objects.profile.pdo.sync_only;
    matches!(index, 0x1005 | 0x1400..=0x1BFF)
        || sync_only.is_some_and(|(switch, _)| switch == index)
        || repeat.is_some_and(|first| (first..first + crate::pdo::MAX).contains(&index))
}
