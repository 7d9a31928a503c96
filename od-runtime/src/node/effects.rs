//! Effects of a call: services read changed objects again, saves end, errors go out.

use od_model::Address;
use od_wire::Instant;
use od_wire::nmt::State;

use super::ear::Ear;
use super::{Event, Machines};
use crate::application::Signals;
use crate::deadline::Deadline;
use crate::device::Device;
use crate::error_control;
use crate::extras::Extras;
use crate::objects::Objects;
use crate::objects::outbox::Effect;
use crate::rooms::Room;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// The end of a call: services read changed objects again, errors go out, and changed values
    /// cause event-driven PDOs.
    #[cfg_attr(target_os = "none", inline(never))]
    #[cfg_attr(not(target_os = "none"), inline)]
    pub(super) fn finish(&mut self, objects: &mut Objects<'_, D>) {
        if !objects.outbox.is_empty() {
            self.empty_outbox(objects);
        }
        if D::CHANGES && self.watches_changes {
            self.notice_changes(objects);
        }
    }

    #[inline(never)]
    fn notice_changes(&mut self, objects: &mut Objects<'_, D>) {
        if self.state == State::Operational {
            self.each_tpdo(|pdo| pdo.notice_change(objects));
        }
    }

    /// Asks the application what is due.
    #[inline(never)]
    pub(super) fn tick(&mut self, objects: &mut Objects<'_, D>) {
        let at = objects.application(|application, context| application.tick(context));
        self.tick_at = Deadline::of(at);
    }

    #[cold]
    fn empty_outbox(&mut self, objects: &mut Objects<'_, D>) {
        self.next = Instant::ZERO;
        self.apply_effects(objects);
        if objects.outbox.signals.take(Signals::TICK) {
            self.tick(objects);
        }
        let send_time = if D::TIME { 0 } else { Signals::SEND_TIME };
        let keep = if D::STORAGE { 0 } else { Signals::KEEP };
        if const { !(D::TIME && D::STORAGE) } {
            // Nobody carries these out.
            objects.outbox.signals.take(send_time | keep);
        }
        if D::TIME && objects.outbox.signals.take(Signals::SEND_TIME) {
            self.produce_time(objects);
        }
        if D::STORAGE && objects.outbox.signals.take(Signals::KEEP) && objects.keep() {
            self.event(Event::NotSaved);
        }
        self.take_errors(objects);
        // A frame that filled it made the node listen to everything.
        if self.ear.codes == Ear::EVERYTHING {
            self.listen(objects);
        }
    }

    /// A request of the client of the default server. What it commands is carried out here: nothing is as
    /// deep in the stack as a save.
    #[inline(never)]
    pub(super) fn ask(&mut self, objects: &mut Objects<'_, D>, data: &[u8; 8], dlc: u8) {
        self.handle_sdo(objects, data, dlc);
        if let Some(done) = objects.carry_out() {
            self.answer_late(objects, done);
        }
    }

    #[inline(never)]
    fn handle_sdo(&mut self, objects: &mut Objects<'_, D>, data: &[u8; 8], dlc: u8) {
        if let Some(answer) = self.sdo.handle(objects, data, dlc) {
            self.answer(answer);
        }
    }

    /// The answer that waited for the end of a command.
    #[inline(never)]
    fn answer_late(&mut self, objects: &mut Objects<'_, D>, done: bool) {
        if let Some(answer) = self.sdo.finish(objects, done) {
            self.answer(answer);
        }
    }

    /// A save that took its time is complete: its request is answered, and the one behind it.
    #[cold]
    pub(super) fn end_save(&mut self, objects: &mut Objects<'_, D>) {
        self.save_at = Room::BLANK;
        let Some(done) = objects.complete_save() else {
            return;
        };
        self.end_save_of_servers(objects, done);
        if D::SERVERS && !self.sdo.awaits_save() {
            return;
        }
        self.answer_late(objects, done);
        if let Some((data, dlc)) = self.sdo.held() {
            self.ask(objects, &data, dlc);
        }
    }

    fn apply_effects(&mut self, objects: &mut Objects<'_, D>) {
        let overflow = core::mem::take(&mut objects.outbox.overflow);
        let mut communication = objects.outbox.signals.take(Signals::RECONFIGURE) || overflow;
        let mut heartbeat = overflow;
        let mut monitor = overflow;
        while let Some(effect) = objects.outbox.effects().pop() {
            self.event(match effect {
                Effect::Written { index, sub } => {
                    let address = Address::new(index, sub);
                    heartbeat |= address.index == 0x1017 || switches(objects, address.index);
                    monitor |= error_control::is_configuration(address.index, objects.profile());
                    communication |= is_configuration(objects, address.index);
                    Event::Written(address)
                }
                _ if !D::STORAGE => continue,
                Effect::Saved(sub) => Event::Saved(sub),
                Effect::NotSaved => Event::NotSaved,
                Effect::Saving => {
                    self.save_at.all_mut().fill(objects.save_due());
                    continue;
                }
                Effect::Restored(sub) => {
                    let at_once =
                        objects.profile().store.restore == crate::profile::Restore::AtOnce;
                    communication |= at_once;
                    heartbeat |= at_once;
                    monitor |= at_once;
                    Event::Restored(sub)
                }
            });
        }
        if heartbeat {
            self.heartbeat
                .configure::<D>(&objects.store, objects.profile(), objects.now);
        }
        if Self::HAS_MONITOR && monitor {
            self.wanted_changed = true;
            self.monitor
                .configure::<D>(&objects.store, objects.profile());
            self.poll_monitor(objects);
        }
        if communication {
            self.configure(objects);
        }
    }
}

/// Whether it is the object that switches from heartbeat to node guarding.
fn switches<D: Device>(objects: &Objects<'_, D>, index: u16) -> bool {
    objects
        .profile()
        .guarding_switch
        .is_some_and(|(switch, _)| switch == index)
}

/// Whether it is an object that configures SYNC, EMCY, TIME, a PDO or a further SDO server.
fn is_configuration<D: Device>(objects: &Objects<'_, D>, index: u16) -> bool {
    let repeat = objects.profile().pdo.repeat_counter;
    let sync_only = objects.profile().pdo.sync_only;
    matches!(index, 0x1005 | 0x1014 | 0x1400..=0x1BFF)
        || D::SYNC_PRODUCER && index == 0x1006
        || D::TIME && index == 0x1012
        || D::SERVERS && matches!(index, 0x1201..=0x127F)
        || sync_only.is_some_and(|(switch, _)| switch == index)
        || repeat.is_some_and(|first| (first..first + crate::pdo::MAX).contains(&index))
}
