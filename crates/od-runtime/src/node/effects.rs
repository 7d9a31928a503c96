//! Effects at the end of a call: services read changed objects again, saves end, errors are
//! reported.

use od_model::Address;
use od_wire::nmt::State;

use super::{Event, Machines};
use crate::application::{Reset, Signals};
use crate::deadline::Deadline;
use crate::device::Device;
use crate::objects::Objects;
use crate::objects::outbox::Effect;
use crate::{error_control, pdo};

impl<D: Device> Machines<D> {
    /// Ends a call: services read changed objects again, errors are reported, changed values cause
    /// event-driven PDOs, and a reset that the error behaviour requested follows.
    pub(super) fn finish(&mut self, objects: &mut Objects<'_, D>) {
        if !objects.outbox.is_empty() {
            self.empty_outbox(objects);
        }
        if D::CHANGES && self.watches_changes && self.state == State::Operational {
            self.each_tpdo(|pdo, mapped| pdo.notice_change(objects, mapped));
        }
        if D::BEHAVIOUR && self.reset_due {
            self.reset(objects, Reset::Node);
        }
    }

    /// Calls the application's `tick`.
    pub(super) fn tick(&mut self, objects: &mut Objects<'_, D>) {
        let at = objects.application(|application, context| application.tick(context));
        self.tick_at = Deadline::of(at);
    }

    fn empty_outbox(&mut self, objects: &mut Objects<'_, D>) {
        self.apply_effects(objects);
        if objects.outbox.signals.take(Signals::TICK) {
            self.tick(objects);
        }
        let send_time = if D::TIME { 0 } else { Signals::SEND_TIME };
        let keep = if D::STORAGE { 0 } else { Signals::KEEP };
        if const { !(D::TIME && D::STORAGE) } {
            // The device lacks these services, so their requests are dropped.
            objects.outbox.signals.take(send_time | keep);
        }
        if D::TIME && objects.outbox.signals.take(Signals::SEND_TIME) {
            self.produce_time(objects);
        }
        if D::STORAGE && objects.outbox.signals.take(Signals::KEEP) && objects.keep() {
            self.event(Event::NotSaved);
        }
        self.take_errors(objects);
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
                    heartbeat |=
                        index == 0x1017 || error_control::is_switch(index, objects.profile);
                    monitor |= error_control::is_configuration(index, objects.profile);
                    communication |= is_configuration(objects, index);
                    Event::Written(address)
                }
                _ if !D::STORAGE => continue,
                Effect::Saved(sub) => Event::Saved(sub),
                Effect::NotSaved => Event::NotSaved,
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
                .configure::<D>(&objects.store, objects.profile, objects.now);
        }
        if (D::GUARDING || D::CONSUMER) && monitor {
            self.monitor()
                .configure::<D>(&objects.store, objects.profile);
            self.listen(objects);
            self.poll_monitor(objects);
        }
        if communication {
            self.configure(objects);
        }
    }
}

/// Returns whether the object configures SYNC, EMCY, TIME, a PDO or a further SDO server.
fn is_configuration<D: Device>(objects: &Objects<'_, D>, index: u16) -> bool {
    let repeat = objects.profile.pdo.repeat_counter;
    let sync_only = objects.profile.pdo.sync_only;
    matches!(index, 0x1005 | 0x1014 | 0x1019 | 0x1400..=0x1BFF)
        || D::SYNC_PRODUCER && index == 0x1006
        || D::TIME && index == 0x1012
        || D::SERVERS && matches!(index, 0x1201..=0x127F)
        || sync_only.is_some_and(|(switch, _)| switch == index)
        || repeat.is_some_and(|first| (first..first + pdo::MAX).contains(&index))
}
