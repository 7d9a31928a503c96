//! The encoder as the [`Application`] behind a node.

use od_model::typed::{Scalar, Var};
use od_model::{Address, Entry, Kind};

use super::{Encoder, OperatingTime};
use crate::{AbortCode, Application, Context, Instant, NodeId, Reset, Store};

const POSITION: u16 = 0x6004;
const OFFSET: Address = Address::new(0x6509, 0);
const TIMER: Address = Address::new(0x6200, 0);
const EVENT_TIMER: Address = Address::new(0x1800, 5);
const OPERATING_TIME: Address = Address::new(0x6508, 0);

/// How often the time of operation goes into the store by itself.
const SIX_MINUTES: u64 = 360_000_000;

impl Application for Encoder {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        let starts = matches!(reset, Reset::PowerOn | Reset::Node);
        if starts {
            let stored = self
                .profile
                .seconds
                .map_or(0, |at| cx.store.unsigned(at.index, at.sub));
            self.seconds = self.seconds_at(cx.now).max(stored as u32);
            self.started = Some(cx.now);
            self.kept = 0;
            self.faults.reset(cx, self.profile.reports);
            self.bit_rate = self.starting_bit_rate(cx.store);
        }
        if let Some(serial_number) = self.serial_number {
            for address in [Address::new(0x1018, 4), Address::new(0x650B, 0)] {
                cx.store.set_unsigned(address, serial_number.into());
            }
        }
        self.position = position_handle(cx.store);
        self.configure(cx.store);
        if reset == Reset::PowerOn {
            self.wake_up(cx.now);
        }
        self.agree_on_timer(cx, starts);
        self.show_time(cx);
    }

    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        let index = self.profile.node_id?;
        let switches = NodeId::new(self.switches.node_id);
        switches.or_else(|| NodeId::new(u8::try_from(store.unsigned(index, 0)).ok()?))
    }

    #[inline]
    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        if address.index == POSITION {
            if let Some(handle) = self.position {
                cx.store
                    .set(handle, self.scale.position(self.angle(cx.now)));
            }
        } else if address == OPERATING_TIME || Some(address) == self.profile.seconds {
            self.show_time(cx);
        }
        Ok(())
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        let number = match cx.store.dictionary().find(address) {
            Ok(Entry { data_type, .. }) if data_type.kind() == Kind::Unsigned => {
                u64::from_wire(value)
            }
            _ => return Ok(()),
        };
        let profile = self.profile;
        if Some(address.index) == profile.bit_rate {
            let code = usize::try_from(number).unwrap_or(usize::MAX);
            return match profile.bit_rates.get(code) {
                Some(1..) => Ok(()),
                _ => Err(AbortCode::ValueRange),
            };
        }
        if let Some((_, list)) = profile.lists.iter().find(|(at, _)| *at == address) {
            let listed = u8::try_from(number).is_ok_and(|number| list.contains(&number));
            return if listed {
                Ok(())
            } else {
                Err(AbortCode::ValueRange)
            };
        }
        match address.index {
            _ if Some(address.index) == profile.node_id => self.between(number, 1, 127),
            0x6001 => self.between(number, 1, self.sensor.steps.into()),
            0x6002 if number == 0 && profile.zero_is_full => Ok(()),
            0x6002 => self.between(number, 1, self.most()),
            0x6003 => self.between(number, 0, self.scale.range() - 1),
            _ => Ok(()),
        }
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        match address.index {
            0x6000 => self.configure(cx.store),
            0x6001 | 0x6002 => {
                if !self.has_option(cx.store, |options| options.keep_offset) {
                    cx.store.set_unsigned(OFFSET, 0);
                }
                self.configure(cx.store);
            }
            0x6003 => {
                let preset = cx.store.unsigned(0x6003, 0) as u32;
                let offset = if self.profile.signed_offset {
                    let position = self.scale.without_offset(self.angle(cx.now));
                    u64::from(preset).wrapping_sub(position)
                } else {
                    self.scale.offset_for(self.angle(cx.now), preset).into()
                };
                cx.store.set_unsigned(OFFSET, offset);
                self.configure(cx.store);
            }
            index if address == TIMER || self.profile.options.is_some_and(|o| o.index == index) => {
                self.timer_to_event_timer(cx);
            }
            _ if address == EVENT_TIMER => self.event_timer_to_timer(cx),
            _ => {}
        }
    }

    fn error_info(&self, store: &Store<'_>) -> [u8; 5] {
        super::faults::info(store)
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        self.faults.report(cx, self.profile.reports);
        self.profile.seconds?;
        self.show_time(cx);
        let (periods, since) = (
            self.micros(cx.now) / SIX_MINUTES,
            self.micros(cx.now) % SIX_MINUTES,
        );
        // A host ticks on other occasions, too.
        if periods > self.kept {
            self.kept = periods;
            cx.signals.keep();
        }
        Some(cx.now.plus_micros(SIX_MINUTES - since))
    }
}

impl Encoder {
    fn between(&self, number: u64, low: u64, high: u64) -> Result<(), AbortCode> {
        if number > high {
            Err(AbortCode::ValueTooHigh)
        } else if number < low {
            Err(self.profile.below_limit)
        } else {
            Ok(())
        }
    }

    /// Is one of these bits of the manufacturer options set?
    fn has_option(&self, store: &Store<'_>, bits: impl Fn(&super::Options) -> u32) -> bool {
        let Some(options) = &self.profile.options else {
            return false;
        };
        store.unsigned(options.index, 0) & u64::from(bits(options)) != 0
    }

    /// What 1800h:05 is later than 6200h, in milliseconds.
    fn delay(&self, store: &Store<'_>) -> u64 {
        match &self.profile.options {
            Some(options) if self.has_option(store, |options| options.delay_timer) => {
                options.delay_ms.into()
            }
            _ => 0,
        }
    }

    /// 6200h rules: 1800h:05 follows. 0 is off in both.
    fn timer_to_event_timer(&mut self, cx: &mut Context<'_, '_>) {
        let Some(timer) = cx.store.try_unsigned(TIMER.index, TIMER.sub) else {
            return;
        };
        self.timer = timer;
        let event_timer = match timer {
            0 => 0,
            timer => (timer + self.delay(cx.store)).min(u16::MAX.into()),
        };
        let old = cx.store.try_unsigned(EVENT_TIMER.index, EVENT_TIMER.sub);
        if old.is_some_and(|old| old != event_timer) {
            cx.store.set_unsigned(EVENT_TIMER, event_timer);
            cx.signals.reconfigure();
        }
    }

    /// 1800h:05 rules: 6200h follows.
    fn event_timer_to_timer(&mut self, cx: &mut Context<'_, '_>) {
        if let Some(event_timer) = cx.store.try_unsigned(EVENT_TIMER.index, EVENT_TIMER.sub) {
            self.timer = event_timer.saturating_sub(self.delay(cx.store));
            cx.store.set_unsigned(TIMER, self.timer);
        }
    }

    /// After a reset the two timers may say different things. What changed rules: at a
    /// start, what storage held; else, what the reset took back.
    fn agree_on_timer(&mut self, cx: &mut Context<'_, '_>, starts: bool) {
        if cx.store.dictionary().find(TIMER).is_err() {
            return;
        }
        let changed = |at: Address, was: u64| match cx.store.dictionary().find(at) {
            Ok(entry) if starts => !cx.store.is_default(entry),
            Ok(entry) => cx.store.number(entry) != was,
            Err(_) => false,
        };
        let was = match self.timer {
            0 => 0,
            timer => timer + self.delay(cx.store),
        };
        if changed(EVENT_TIMER, was) && !(starts && changed(TIMER, self.timer)) {
            self.event_timer_to_timer(cx);
        } else {
            self.timer_to_event_timer(cx);
        }
    }

    fn show_time(&self, cx: &mut Context<'_, '_>) {
        if let Some(seconds) = self.profile.seconds {
            cx.store
                .set_unsigned(seconds, self.seconds_at(cx.now).into());
        }
        if self.profile.operating_time == OperatingTime::SinceStart {
            let time = self.micros(cx.now) / SIX_MINUTES;
            cx.store
                .set_unsigned(OPERATING_TIME, time.min(u32::MAX.into()));
        }
    }

    /// Switches rule the bit rate where they rule the node ID.
    fn starting_bit_rate(&self, store: &Store<'_>) -> Option<u16> {
        let profile = self.profile;
        let rate = if self.switches.node_id != 0 && !profile.switch_rates.is_empty() {
            profile
                .switch_rates
                .get(usize::from(self.switches.bit_rate))
        } else {
            let code = usize::try_from(store.unsigned(profile.bit_rate?, 0)).ok()?;
            profile.bit_rates.get(code)
        };
        rate.copied().filter(|rate| *rate != 0)
    }
}

/// The handle of 6004h, whatever its width; it lies in the store where it lies.
fn position_handle(store: &Store<'_>) -> Option<Var<u32, od_model::typed::Ro>> {
    let entry = store.dictionary().entry(POSITION, 0)?;
    let is_integer = matches!(entry.data_type.kind(), Kind::Unsigned | Kind::Signed);
    is_integer.then(|| {
        Var::new(
            entry.address,
            entry.slot,
            entry.data_type.bits().unwrap_or(32),
        )
    })
}
