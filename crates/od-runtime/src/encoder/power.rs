//! Power-on, power-off and NMT reset node: operating time, power-on cycles, bit rate.

use od_model::Address;

use super::faults::Off;
use super::motion::Motion;
use super::profile::{Family, Role};
use super::state::Encoder;
use crate::application::{Context, Reset};
use crate::store::Store;
use od_wire::Instant;

/// Microseconds between two saves of the operating time.
const SIX_MINUTES: u64 = 360_000_000;

impl<M: Motion, F: Family> Encoder<M, F> {
    /// Switches the power off; the shaft may continue to turn. Only a simulation continues after this.
    pub fn power_off(&mut self, now: Instant) {
        self.seconds = self.seconds_at(now);
        self.started = None;
        self.off = Some(now);
        self.shaft.power_off(now);
    }

    /// Starts the device: at power-on and NMT reset node.
    pub(super) fn start(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        let [seconds, cycles] = [Role::Seconds, Role::Cycles].map(|of| self.profile().object(of));
        let number = |at: Option<Address>| match at {
            Some(at) => cx.store.unsigned(at.index, at.sub) as u32,
            None => 0,
        };
        let stored = number(seconds);
        self.seconds = self.seconds_at(cx.now).max(stored);
        self.cycles = self.cycles.max(number(cycles));
        self.started = Some(cx.now);
        self.keep_at = seconds.map(|_| cx.now.plus_micros(SIX_MINUTES));
        let off = match (reset, self.off.take()) {
            (Reset::PowerOn, Some(at)) => Off::For(cx.now.micros_since(at)),
            (Reset::PowerOn, None) => Off::Always,
            _ => Off::Never,
        };
        self.faults.reset(cx, self.profile().reports, off);
        self.bit_rate = self.starting_bit_rate(cx.store);
        if let Some(cycles) = cycles {
            if reset == Reset::PowerOn {
                self.cycles = self.cycles.saturating_add(1);
                cx.signals.keep();
            }
            cx.store.set_unsigned(cycles, self.cycles.into());
        }
        self.restart_movements(cx, |_| true);
        self.engage_gear(cx.store);
    }

    /// Returns the operating time at `now`, in seconds (MANUALS.md C-GX-27).
    pub(super) fn seconds_at(&self, now: Instant) -> u32 {
        self.seconds.saturating_add(self.seconds_since_start(now))
    }

    /// Returns the microseconds since the last start.
    pub(super) fn micros(&self, now: Instant) -> u64 {
        self.started.map_or(0, |started| now.micros_since(started))
    }

    /// Returns the seconds since the last start.
    pub(super) fn seconds_since_start(&self, now: Instant) -> u32 {
        u32::try_from(self.micros(now) / 1_000_000).unwrap_or(u32::MAX)
    }

    /// Updates the objects that show an operating time.
    pub(super) fn show_time(&mut self, cx: &mut Context<'_, '_>) {
        let times = self.profile().objects.iter().filter(|(_, of)| of.is_time());
        for (address, role) in times {
            self.show(cx, *address, role);
        }
    }

    /// Saves the operating time every six minutes. Returns the time of the next save.
    pub(super) fn keep_time(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        if let Some(at) = self.keep_at.filter(|at| *at <= cx.now) {
            self.keep_at = Some(at.next_period(SIX_MINUTES, cx.now));
            self.show_time(cx);
            cx.signals.keep();
        }
        self.keep_at
    }

    /// Returns the bit rate at a start, in kbit/s. If the rotary switches set the node ID, the DIP switches
    /// set the bit rate (MANUALS.md C-GX-35), unless their position has none; otherwise the object sets it.
    fn starting_bit_rate(&self, store: &Store<'_>) -> Option<u16> {
        let profile = self.profile();
        let by_switch = match self.switches.node_id {
            0 => None,
            _ => profile
                .switch_rates
                .get(usize::from(self.switches.bit_rate)),
        };
        let is_rate = |rate: &&u16| **rate != 0;
        let rate = by_switch.filter(is_rate).or_else(|| {
            let at = profile.object(Role::BitRate)?;
            let code = store.unsigned(at.index, at.sub);
            let rate = profile.bit_rates.get(usize::try_from(code).ok()?);
            rate.filter(is_rate)
        });
        rate.copied()
    }
}
