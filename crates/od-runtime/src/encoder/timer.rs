//! Cyclic timer (CiA 406, object 6200h) and event timer of TPDO1 (1800h:05): two objects with one
//! value (MANUALS.md C-GX-26).

use od_model::Address;

use super::motion::Motion;
use super::profile::Family;
use super::state::Encoder;
use crate::application::Context;
use crate::store::Store;

/// Cyclic timer (CiA 406), in milliseconds.
pub(super) const TIMER: Address = Address::new(0x6200, 0);
/// Event timer of TPDO1 (CiA 301), in milliseconds.
pub(super) const EVENT_TIMER: Address = Address::new(0x1800, 5);

impl<M: Motion, F: Family> Encoder<M, F> {
    /// Returns by how many milliseconds 1800h:05 is longer than 6200h (MANUALS.md C-GX-26).
    fn delay(&self, store: &Store<'_>) -> u64 {
        match &self.profile().options {
            Some(options) if self.has_option(store, |options| options.delay_timer) => {
                options.delay_ms.into()
            }
            _ => 0,
        }
    }

    /// Returns 1800h:05 for a value of 6200h; 0 is off in both.
    fn event_timer(&self, store: &Store<'_>, timer: u64) -> u64 {
        match timer {
            0 => 0,
            timer => (timer + self.delay(store)).min(u16::MAX.into()),
        }
    }

    /// Sets 1800h:05 from 6200h.
    pub(super) fn timer_to_event_timer(&mut self, cx: &mut Context<'_, '_>) {
        let Some(timer) = cx.store.try_unsigned(TIMER.index, TIMER.sub) else {
            return;
        };
        self.timer = timer;
        let event_timer = self.event_timer(cx.store, timer);
        let old = cx.store.try_unsigned(EVENT_TIMER.index, EVENT_TIMER.sub);
        if old.is_some_and(|old| old != event_timer) {
            cx.store.set_unsigned(EVENT_TIMER, event_timer);
            cx.signals.reconfigure();
        }
    }

    /// Sets 6200h from 1800h:05.
    pub(super) fn event_timer_to_timer(&mut self, cx: &mut Context<'_, '_>) {
        if let Some(event_timer) = cx.store.try_unsigned(EVENT_TIMER.index, EVENT_TIMER.sub) {
            self.timer = event_timer.saturating_sub(self.delay(cx.store));
            cx.store.set_unsigned(TIMER, self.timer);
        }
    }

    /// Makes the two objects equal after a reset. Of the two, the one that changed applies: if the
    /// reset loaded both, the one that storage held; else the one that was loaded.
    pub(super) fn agree_on_timer(&mut self, cx: &mut Context<'_, '_>, starts: bool) {
        if cx.store.dictionary().row_at(TIMER).is_none() {
            return;
        }
        let starts = starts || cx.store.unsigned(TIMER.index, TIMER.sub) != self.timer;
        let changed = |at: Address, was: u64| match cx.store.dictionary().row_at(at) {
            Some(row) if starts => !cx.store.has_default(row),
            Some(row) => cx.store.number_of(row) != was,
            None => false,
        };
        let was = self.event_timer(cx.store, self.timer);
        if changed(EVENT_TIMER, was) && !(starts && changed(TIMER, self.timer)) {
            self.event_timer_to_timer(cx);
        } else {
            self.timer_to_event_timer(cx);
        }
    }
}
