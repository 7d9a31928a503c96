//! Power comes and goes: what the encoder counts of its life.

use od_model::Address;

use super::faults::Off;
use super::{Encoder, Motion, OperatingTime};
use crate::application::{Context, Reset};
use crate::store::Store;
use od_wire::Instant;

pub(super) const OPERATING_TIME: Address = Address::new(0x6508, 0);

/// How often the time of operation goes into the store by itself.
const SIX_MINUTES: u64 = 360_000_000;

impl<M: Motion> Encoder<M> {
    /// Power goes; the shaft may turn on. Only a simulation outlives this.
    pub fn power_off(&mut self, now: Instant) {
        self.seconds = self.seconds_at(now);
        self.started = None;
        self.off = Some(now);
        self.shaft.power_off(now);
    }

    /// The device starts: power came, or NMT reset node.
    pub(super) fn start(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        let number = |at: Option<Address>| match at {
            Some(at) => cx.store.unsigned(at.index, at.sub) as u32,
            None => 0,
        };
        let stored = number(self.profile.seconds);
        self.seconds = self.seconds_at(cx.now).max(stored);
        self.cycles = self.cycles.max(number(self.profile.cycles));
        self.started = Some(cx.now);
        self.keep_at = cx.now.plus_micros(SIX_MINUTES);
        let off = match (reset, self.off.take()) {
            (Reset::PowerOn, Some(at)) => Off::For(cx.now.micros_since(at)),
            (Reset::PowerOn, None) => Off::Always,
            _ => Off::Never,
        };
        self.faults.reset(cx, self.profile.reports, off);
        self.bit_rate = self.starting_bit_rate(cx.store);
        if let Some(cycles) = self.profile.cycles {
            if reset == Reset::PowerOn {
                self.cycles = self.cycles.saturating_add(1);
                cx.signals.keep();
            }
            cx.store.set_unsigned(cycles, self.cycles.into());
        }
        self.forget_movements(cx, |_| true);
        self.engage_gear(cx.store);
    }

    /// Seconds of operation, up to `now`.
    pub(super) fn seconds_at(&self, now: Instant) -> u32 {
        let seconds = self.micros(now) / 1_000_000;
        self.seconds
            .saturating_add(u32::try_from(seconds).unwrap_or(u32::MAX))
    }

    /// Microseconds since the last start.
    pub(super) fn micros(&self, now: Instant) -> u64 {
        self.started.map_or(0, |started| now.micros_since(started))
    }

    /// Is it an object that shows time or how often power came?
    pub(super) fn is_time(&self, address: Address) -> bool {
        let profile = self.profile;
        let at = Some(address);
        address == OPERATING_TIME || at == profile.seconds || at == profile.seconds_since_start
    }

    /// The objects that show time.
    pub(super) fn show_time(&self, store: &mut Store<'_>, now: Instant) {
        let seconds = self.seconds_at(now);
        if let Some(at) = self.profile.seconds {
            store.set_unsigned(at, seconds.into());
        }
        if let Some(at) = self.profile.seconds_since_start {
            let seconds = self.micros(now) / 1_000_000;
            store.set_unsigned(at, seconds.min(u32::MAX.into()));
        }
        let time = match self.profile.operating_time {
            OperatingTime::Constant => return,
            OperatingTime::SinceStart => self.micros(now) / SIX_MINUTES,
            OperatingTime::Total => u64::from(seconds) * 1_000_000 / SIX_MINUTES,
        };
        store.set_unsigned(OPERATING_TIME, time.min(u32::MAX.into()));
    }

    /// Saves the record of the device's life every six minutes. Answers when it is due.
    pub(super) fn keep_time(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        self.profile.seconds?;
        // A host ticks on other occasions, too.
        if self.keep_at <= cx.now {
            self.keep_at = self.keep_at.next_period(SIX_MINUTES, cx.now);
            self.show_time(cx.store, cx.now);
            cx.signals.keep();
        }
        Some(self.keep_at)
    }

    /// Switches rule the bit rate where they rule the node ID, unless their position has none.
    fn starting_bit_rate(&self, store: &Store<'_>) -> Option<u16> {
        let profile = self.profile;
        let by_switch = match self.switches.node_id {
            0 => None,
            _ => profile
                .switch_rates
                .get(usize::from(self.switches.bit_rate)),
        };
        let is_rate = |rate: &&u16| **rate != 0;
        let rate = by_switch.filter(is_rate).or_else(|| {
            let code = store.unsigned(profile.bit_rate?, 0);
            let rate = profile.bit_rates.get(usize::try_from(code).ok()?);
            rate.filter(is_rate)
        });
        rate.copied()
    }
}
