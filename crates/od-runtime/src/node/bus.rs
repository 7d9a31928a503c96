//! State changes and frame losses of the CAN controller, and their effects.

use od_wire::Instant;
use od_wire::nmt::State;

use super::controller::{BusEvent, Mute};
use super::event::Event;
use super::{Machines, Node};
use crate::application::{Application, Reset};
use crate::device::Device;
use crate::emcy::{PDO_LENGTH, RPDO_TIMEOUT, SYNC_LENGTH};
use crate::objects::Objects;
use crate::profile::Notice;
use crate::rooms::Rooms;
use crate::storage::Storage;

impl<D: Device, A: Application, S: Storage> Node<D, A, S> {
    /// Reports a state change or a lost frame of the CAN controller. A host that never calls this
    /// runs the node as on an error-free bus.
    pub fn handle_bus(&mut self, now: Instant, event: BusEvent) {
        self.call(now, |node, objects| node.take_bus(objects, event));
    }
}

impl<D: Device> Machines<D> {
    pub(super) const fn is_bus_off(&self) -> bool {
        matches!(self.bus, BusEvent::Off)
    }

    /// Handles a report of the CAN controller.
    fn take_bus(&mut self, objects: &mut Objects<'_, D>, event: BusEvent) {
        // While the node initialises, the controller is being set up, and its reports do not count.
        if self.state == State::Initialising {
            return;
        }
        let profile = objects.profile.errors;
        let restarts = profile
            .off
            .restart
            .is_none_or(|switch| objects.has_bits(switch));
        if self.is_bus_off() {
            if event != BusEvent::Active || !restarts {
                return;
            }
            if profile.off.boots {
                return self.reset(objects, Reset::Communication);
            }
            self.leave_bus_off(objects);
        } else if event == BusEvent::Off {
            self.enter_bus_off(objects, restarts);
        } else {
            self.take_state(objects, event);
        }
        self.finish(objects);
    }

    /// Handles warning, error passive, overrun, and the return from these states.
    fn take_state(&mut self, objects: &mut Objects<'_, D>, event: BusEvent) {
        let profile = objects.profile.errors;
        let info = objects.application.error_info(&objects.store);
        let signals = &mut objects.outbox.signals;
        if event == BusEvent::Overrun {
            if let Some(notice) = profile.overrun {
                signals.raise(notice.error(info));
            }
            return;
        }
        let worse = event.level() > self.bus.level();
        self.bus = event;
        let states = [
            (BusEvent::Passive, profile.bus_passive),
            (BusEvent::Warning, profile.bus_warning),
            (BusEvent::Overrun, profile.overrun),
        ];
        for (state, notice) in states {
            let Some(notice) = notice else { continue };
            if state == event && worse {
                signals.raise(notice.error(info));
            } else if state.level() > event.level() || event == BusEvent::Active {
                signals.clear(notice.code, info);
            }
        }
    }

    /// Enters bus-off: the node neither sends nor receives, and 1029h acts as the profile says.
    fn enter_bus_off(&mut self, objects: &mut Objects<'_, D>, restarts: bool) {
        let profile = objects.profile.errors;
        if let Some(bit_rate) = self.mute.and_then(Mute::bit_rate) {
            self.event(Event::BitRate(bit_rate));
        }
        self.bus = BusEvent::Off;
        self.mute = Some(Mute::BUS_OFF);
        self.event(Event::BusOff { restarts });
        self.rooms.all_mut().frames.clear();
        self.cut_transfers(objects);
        self.stop_pdos();
        objects.application(|application, cx| application.master_lost(cx));
        let set = self.emcy().set_silent(&mut objects.store, profile.bus_off);
        if !(restarts && profile.off.behaviour_if_off) {
            self.react(objects, set, true);
        }
        // The reaction of 1029h may have changed the NMT state, but the node is still bus-off.
        self.stop_pdos();
    }

    /// Leaves bus-off: the CAN controller restarted, and the NMT state stays.
    fn leave_bus_off(&mut self, objects: &mut Objects<'_, D>) {
        self.mute = None;
        self.event(Event::BusOn);
        self.emcy().set_silent(&mut objects.store, 0);
        self.take_state(objects, BusEvent::Active);
        let info = objects.application.error_info(&objects.store);
        if let Some(notice) = objects.profile.errors.bus_recovered {
            objects.outbox.signals.raise(notice.error(info));
            objects.outbox.signals.clear(notice.code, info);
        }
        if self.state == State::Operational {
            self.start_pdos(objects);
        }
    }

    /// Ends a switch delay of LSS.
    pub(super) fn end_mute(&mut self) {
        let Some(mute) = self.mute.take() else { return };
        if let Some(bit_rate) = mute.bit_rate() {
            self.event(Event::BitRate(bit_rate));
            if mute.silence_ms > 0 {
                self.mute = Some(Mute {
                    until: mute.until.plus_millis(mute.silence_ms.into()),
                    bit_rate: 0,
                    silence_ms: 0,
                });
            }
        }
    }

    /// Ends the errors of communication without an EMCY message: in a reset the monitor and the CAN
    /// controller restart.
    pub(super) fn forget_bus_errors(&mut self, objects: &mut Objects<'_, D>) {
        let profile = &objects.profile.errors;
        let is_of_bus = |code| {
            let is = |notice: &Option<Notice>| notice.is_some_and(|notice| notice.code == code);
            matches!(code, PDO_LENGTH | SYNC_LENGTH | RPDO_TIMEOUT)
                || code == profile.lost.code
                || is(&profile.bus_warning)
                || is(&profile.bus_passive)
                || is(&profile.bus_recovered)
                || is(&profile.overrun)
        };
        self.emcy().forget(&mut objects.store, is_of_bus);
    }
}
