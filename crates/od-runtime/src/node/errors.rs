//! Error behaviour: the reaction to a lost node, or to a bit of 1001h that becomes set (CiA 301,
//! object 1029h).

use super::{Event, Machines};
use crate::device::Device;
use crate::emcy;
use crate::emcy::Change;
use crate::objects::Objects;
use crate::profile::Notice;
use crate::rooms::Rooms;
use crate::store::Store;
use od_wire::emcy::Emcy;
use od_wire::nmt::State;

/// Reaction that 1029h requests, in order of severity.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Behaviour {
    Nothing,
    /// Acts in Operational only; the default of CiA 301 if 1029h is missing (chapter 7.5.2.32).
    PreOperational,
    Stopped,
    Reset,
}

impl Notice {
    /// The EMCY message that reports this error.
    pub(super) const fn error(self, info: [u8; 5]) -> Emcy {
        Emcy {
            code: self.code,
            register: self.register,
            info,
        }
    }
}

impl<D: Device> Machines<D> {
    /// Acts when the monitor has lost a node, or when all nodes have returned.
    pub(super) fn poll_monitor(&mut self, objects: &mut Objects<'_, D>) {
        if (D::GUARDING || D::CONSUMER)
            && let Some(lost) = self.monitor().poll()
        {
            self.report_lost(objects, lost);
        }
    }

    /// Reports a lost node, or that all nodes have returned.
    fn report_lost(&mut self, objects: &mut Objects<'_, D>, lost: bool) {
        let notice = objects.profile.errors.lost;
        let info = objects.application.error_info(&objects.store);
        if lost {
            objects.outbox.signals.raise(notice.error(info));
            objects.application(|application, cx| application.master_lost(cx));
        } else {
            objects.outbox.signals.clear(notice.code, info);
        }
        self.lost = lost;
    }

    /// Carries out 1029h for `bits` of 1001h that became set, or that are still set when the node
    /// enters Operational. If the reaction is Stopped or a reset, the waiting EMCY messages are
    /// sent first.
    pub(super) fn react(&mut self, objects: &mut Objects<'_, D>, bits: u8, lost: bool) {
        if !D::BEHAVIOUR {
            return;
        }
        let profile = &objects.profile.errors;
        let operational = self.state == State::Operational;
        if self.state == State::Initialising || profile.operational_only && !operational {
            return;
        }
        let mut reaction = if lost {
            requested(&objects.store, 1, operational)
        } else {
            Behaviour::Nothing
        };
        for (_, sub) in profile.behaviour.iter().filter(|(of, _)| of & bits != 0) {
            reaction = reaction.max(requested(&objects.store, *sub, operational));
        }
        if reaction >= Behaviour::Stopped && self.sends_emcy() {
            let now = objects.now;
            while let Some(frame) = self.emcy().poll::<D>(&objects.store, now) {
                self.push(frame);
            }
        }
        match reaction {
            Behaviour::Nothing => {}
            Behaviour::PreOperational => self.enter(objects, State::PreOperational),
            Behaviour::Stopped => self.enter(objects, State::Stopped),
            Behaviour::Reset => self.reset_due = true,
        }
    }

    /// Carries out 1029h for the errors that are active when the node enters Operational.
    pub(super) fn react_to_active(&mut self, objects: &mut Objects<'_, D>) {
        let bits = self.emcy.register(self.rooms.all().errors);
        let lost = self.was_lost;
        if bits != 0 || lost {
            self.react(objects, bits, lost);
        }
    }

    /// Handles the errors that began or ended in this call.
    pub(super) fn take_errors(&mut self, objects: &mut Objects<'_, D>) {
        let mut set = 0;
        while let Some(change) = objects.outbox.signals.errors.pop() {
            let send = self.state != State::Stopped && emcy::can_id(&objects.store).is_some();
            let reset = objects.profile.errors.reset;
            let outcome = self
                .emcy()
                .change::<D>(&mut objects.store, change, reset, send);
            set |= outcome.set;
            if outcome.is_news {
                self.event(match change {
                    Change::Raised(error) => Event::Error(error),
                    Change::Cleared { code, .. } => Event::ErrorCleared(code),
                });
            }
            if outcome.is_dropped {
                self.event(Event::EmcyDropped);
            }
        }
        let lost = core::mem::take(&mut self.lost);
        if set != 0 || lost {
            self.react(objects, set, lost);
        }
    }
}

/// Reaction that a sub-index of 1029h requests.
fn requested(store: &Store<'_>, sub: u8, operational: bool) -> Behaviour {
    match store.try_word(0x1029, sub) {
        None | Some(0) if operational => Behaviour::PreOperational,
        Some(2) => Behaviour::Stopped,
        // A value of the bus-cover family; CiA 301 reserves it.
        Some(3) => Behaviour::Reset,
        _ => Behaviour::Nothing,
    }
}
