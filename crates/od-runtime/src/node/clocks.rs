//! SYNC producer, TIME producer and TIME consumer.

use od_wire::nmt::State;
use od_wire::time_of_day::TimeOfDay;
use od_wire::{CanId, CobId, Frame, Instant};

use super::{Machines, Node};
use crate::application::Application;
use crate::device::Device;
use crate::objects::Objects;
use crate::rooms::Rooms;
use crate::storage::Storage;
use crate::store::Store;
use crate::{emcy, sync};

impl<D: Device, A: Application, S: Storage> Node<D, A, S> {
    /// Sends a TIME message with what [`Application::time`](crate::Application::time) returns, as
    /// [`Signals::send_time`](crate::Signals::send_time) does. Returns whether the node sends it: bit 30 of
    /// 1012h is set, and the NMT state is Pre-operational or Operational.
    pub fn send_time(&mut self, now: Instant) -> bool {
        let sent = self.call(now, |node, objects| {
            let sent = D::TIME && node.produce_time(objects);
            node.finish(objects);
            sent
        });
        sent == Some(true)
    }
}

impl<D: Device> Machines<D> {
    /// SYNC and TIME are services of Pre-operational and Operational (CiA 301, table 37).
    fn is_communicating(&self) -> bool {
        matches!(self.state, State::PreOperational | State::Operational)
    }

    /// Reads the objects of SYNC producer and TIME again.
    pub(super) fn configure_clocks(&mut self, objects: &Objects<'_, D>) {
        let may_send = self.is_communicating();
        let Some(clocks) = self.rooms.all_mut().clocks.first_mut() else {
            return;
        };
        if D::SYNC_PRODUCER {
            clocks.sync.configure(&objects.store, objects.now, may_send);
        }
        if D::TIME {
            let cob_id = objects.store.try_word(0x1012, 0);
            let cob_id = cob_id.map(CobId::new);
            let consumed = cob_id.filter(|cob_id| cob_id.consumes_time());
            clocks.time_id = consumed.and_then(CobId::usable_id);
        }
    }

    /// Sends the SYNC that is due, and lets the node's own PDOs act on it.
    pub(super) fn produce_sync(&mut self, objects: &mut Objects<'_, D>) {
        if !D::SYNC_PRODUCER {
            return;
        }
        let Some(clocks) = self.rooms.all_mut().clocks.first_mut() else {
            return;
        };
        let Some(counter) = clocks.sync.handle_timeout(objects.now) else {
            return;
        };
        if self.mute.is_some() {
            return;
        }
        let Some(id) = self.sync_id else {
            return;
        };
        self.push(match counter {
            Some(counter) => Frame::of(id, &[counter]),
            None => Frame::of(id, &[]),
        });
        if self.state == State::Operational {
            self.sync(objects, counter);
        }
    }

    /// Hands the time of a TIME message to the application.
    pub(super) fn handle_time(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) {
        if D::TIME
            && let Some(time) = TimeOfDay::parse(frame.data())
        {
            objects.application(|application, context| application.set_time(context, time));
        }
    }

    /// Sends a TIME message with the application's time.
    pub(super) fn produce_time(&mut self, objects: &mut Objects<'_, D>) -> bool {
        if !self.is_communicating() || self.mute.is_some() {
            return false;
        }
        let Some(id) = produced_time_id(&objects.store) else {
            return false;
        };
        let time = objects.application(|application, context| application.time(context));
        time.is_some_and(|time| self.push(Frame::of(id, &time.emit())))
    }
}

/// CAN-ID of the TIME messages that the node produces (CiA 301, chapter 7.2.6, object 1012h): that of 1012h, if
/// bit 30 is set and neither SYNC nor EMCY has the same CAN-ID.
pub(super) fn produced_time_id(store: &Store<'_>) -> Option<CanId> {
    let cob_id = CobId::new(store.try_word(0x1012, 0)?);
    let id = cob_id.usable_id().filter(|_| cob_id.produces_time())?;
    let others = [sync::can_id(store), emcy::can_id(store)];
    (!others.contains(&Some(id))).then_some(id)
}
