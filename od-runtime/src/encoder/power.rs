//! Power comes and goes: what the encoder counts of its life, and what it makes of a shaft
//! that turned meanwhile.

use od_model::Address;

use super::faults::Off;
use super::{Angle, Counter, Encoder, OperatingTime};
use crate::application::{Context, Reset};
use crate::store::Store;
use od_wire::Instant;

pub(super) const OPERATING_TIME: Address = Address::new(0x6508, 0);

/// How often the time of operation goes into the store by itself.
const SIX_MINUTES: u64 = 360_000_000;

impl Encoder {
    /// Power goes. The shaft may turn on; a counter that misses a crossing of its zero
    /// does not know of it, which shows where the revolutions are no power of two.
    pub fn power_off(&mut self, now: Instant) {
        self.seconds = self.seconds_at(now);
        self.started = None;
        self.off = Some((self.angle(now), now));
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
        self.kept = 0;
        let off = match (reset, self.off) {
            (Reset::PowerOn, Some((_, at))) => Off::For(cx.now.micros_since(at)),
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
        self.forget_movements(cx.now, |_| true);
        self.engage_gear(cx.store);
    }

    /// What the revolution counter makes of where the shaft is now.
    pub(super) fn wake_up(&mut self, now: Instant) {
        let off = self.off.take();
        let on = self.angle(now);
        // Whole ranges that fit into the angle fit into its difference.
        let unseen = match (self.profile.counter, off) {
            (Counter::Volatile, _) => on.fractions() & !0xFFFF_FFFF,
            (_, None) => 0,
            (Counter::Sensor, Some((off, _))) => {
                let range = i128::from(self.sensor.turns) << 32;
                let laps = |angle: Angle| i128::from(angle.fractions()).div_euclid(range);
                ((laps(on) - laps(off)) * range) as i64
            }
            (Counter::Kept { turns }, Some((off, _))) => {
                let turned = i128::from(on.minus(off).fractions());
                let (range, half) = (i128::from(turns.max(1)) << 32, i128::from(turns) << 31);
                if turned.abs() <= half {
                    0
                } else {
                    ((turned + half).div_euclid(range) * range) as i64
                }
            }
        };
        self.unseen = self.unseen.plus(Angle::from_fractions(unseen));
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

    /// Every six minutes the record of the device's life is saved. Answers when it is due.
    pub(super) fn keep_time(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        self.profile.seconds?;
        self.show_time(cx.store, cx.now);
        let micros = self.micros(cx.now);
        let (periods, since) = (micros / SIX_MINUTES, micros % SIX_MINUTES);
        // A host ticks on other occasions, too.
        if periods > self.kept {
            self.kept = periods;
            cx.signals.keep();
        }
        Some(cx.now.plus_micros(SIX_MINUTES - since))
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
