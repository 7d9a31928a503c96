//! Configuration of the position: its objects, and the gear, become a [`Scale`].

use od_model::{Address, Group};

use super::angle::Angle;
use super::family::Family;
use super::motion::{Gain, Motion};
use super::object::Role;
use super::position::Scale;
use super::position::ratio::at_least_1;
use super::profile::{Counter, Gear, GearKind, RangeRule, Total};
use super::rate::KEPT;
use super::state::Encoder;
use crate::store::Store;
use od_wire::AbortCode;

pub(super) const STEPS: Address = Address::new(0x6001, 0);
pub(super) const OFFSET: Address = Address::new(0x6509, 0);

/// Bit 0 of 6000h: the position value increases counter-clockwise.
pub const REVERSED: u64 = 1 << 0;
/// Bit 2 of 6000h: 6001h and 6002h scale the position value.
pub const SCALING: u64 = 1 << 2;

/// Objects of a gear, as they are or with a new value in one of them.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Factor {
    is_on: bool,
    numerator: u32,
    denominator: u32,
}

impl Factor {
    fn load(store: &Store<'_>, gear: Gear, new: Option<(u8, u64)>) -> Self {
        let number = |sub| match new {
            Some((changed, value)) if changed == sub => value,
            _ => store.unsigned(gear.index, sub),
        };
        Self {
            is_on: number(1) == u64::from(gear.on),
            numerator: number(2) as u32,
            denominator: number(3) as u32,
        }
    }

    /// The factor, if it is on and one can divide by it.
    fn ratio(self) -> Option<(u64, u64)> {
        let is_ratio = self.is_on && self.numerator > 0 && self.denominator > 0;
        is_ratio.then_some((self.numerator.into(), self.denominator.into()))
    }
}

impl<M: Motion, F: Family> Encoder<M, F> {
    /// The gear that acts when it is written, if it is on.
    fn output_gear(&self, store: &Store<'_>) -> Option<(u64, u64)> {
        let gear = self
            .profile()
            .gear
            .filter(|gear| gear.kind == GearKind::Output)?;
        Factor::load(store, gear, None).ratio()
    }

    /// The gear that acts at once, as it acts.
    pub(super) fn engaged(&self) -> Option<(u64, u64)> {
        self.output.filter(|_| Self::PARTS.gear)
    }

    /// The position at an angle, as it would be with offset 0.
    #[inline]
    pub(super) fn count(&self, angle: Angle) -> u64 {
        self.scale.count(angle, Self::PARTS.gear)
    }

    /// A start: the gear that storage held acts from now on.
    pub(super) fn engage_gear(&mut self, store: &Store<'_>) {
        let gear = self
            .profile()
            .gear
            .filter(|gear| gear.kind == GearKind::Position);
        self.gear = gear.and_then(|gear| Factor::load(store, gear, None).ratio());
    }

    /// Does 6001h show what the gear makes of it?
    pub(super) fn computes_resolution(&self, store: &Store<'_>) -> bool {
        self.output_gear(store).is_some()
    }

    /// Does a write to this index change a gear that acts, or acted before it?
    pub(super) fn is_acting_gear(&self, store: &Store<'_>, index: u16) -> bool {
        let gear = self.profile().gear;
        let is_gear = gear.is_some_and(|gear| gear.index == index);
        is_gear && (self.engaged().is_some() || self.output_gear(store).is_some())
    }

    /// 6001h; without any the sensor's own, 1 or more.
    fn resolution(&self, store: &Store<'_>) -> u32 {
        match store.unsigned(0x6001, 0) {
            0 => self.sensor.steps.max(1),
            steps => u32::try_from(steps).unwrap_or(u32::MAX),
        }
    }

    /// The range that a value of 6002h means.
    fn range(&self, value: Option<u64>) -> u64 {
        match value {
            Some(0) if self.profile().zero_is_full => 1 << 32,
            Some(0) | None => self.sensor.range(),
            Some(range) => range,
        }
    }

    /// The rule of the objects for the position; also 6500h, which shows 6000h, and what
    /// shows quotients of others.
    pub(super) fn configure(&mut self, store: &mut Store<'_>) {
        let number = |index| store.try_unsigned(index, 0);
        self.sensor = self.profile().sensor_by(number);
        self.rates = [None; KEPT];
        let operating = store.try_unsigned(0x6000, 0).unwrap_or(SCALING);
        let range = self.range(store.try_unsigned(0x6002, 0));
        let output = self.output_gear(store);
        match (self.engaged(), output) {
            (None, Some(_)) => self.own_steps = store.unsigned(STEPS.index, STEPS.sub),
            (Some(_), None) => {
                store.set_unsigned(STEPS, self.own_steps);
            }
            _ => {}
        }
        self.output = output;
        if let Some((numerator, denominator)) = output {
            let steps = range.saturating_mul(denominator) / at_least_1(numerator);
            // The object takes nothing less than 1.
            let steps = steps.clamp(1, u32::MAX.into());
            store.set_unsigned(STEPS, steps);
        }
        let steps = self.resolution(store);
        if self.profile().total == Total::Shown {
            let turns = range / at_least_1(steps.into());
            store.set_unsigned(Address::new(0x6502, 0), turns);
        }
        let scale = if operating & SCALING == 0 {
            self.unscaled()
        } else if let Some((numerator, denominator)) = output {
            // A 6002h of 32 bits times a factor of 32 bits; a sensor's steps are less.
            self.gain = Gain::ratio(range.saturating_mul(denominator), numerator);
            Scale::new(self.sensor, self.sensor.steps, range).with_gear(
                range.saturating_mul(denominator),
                u64::from(self.sensor.steps).saturating_mul(numerator),
            )
        } else {
            self.gain = Gain::steps(steps);
            Scale::new(self.sensor, steps, range)
        };
        let scale = match (
            self.gear.filter(|_| Self::PARTS.gear),
            self.profile().counter,
        ) {
            (Some((numerator, denominator)), _) => scale.with_gear(denominator, numerator),
            (None, Counter::Sensor) => scale,
            (None, Counter::Kept { .. } | Counter::Volatile) if output.is_none() => {
                scale.counting_on()
            }
            _ => scale,
        };
        self.scale = scale
            .with_sense(operating & REVERSED != 0)
            .with_offset(self.offset(store) + self.injected_offset(store));
        let shown = operating & u64::from(self.profile().operating_bits);
        store.set_unsigned(Address::new(0x6500, 0), shown);
    }

    /// The scale with scaling off.
    fn unscaled(&mut self) -> Scale {
        let steps = self.profile().unscaled_steps.unwrap_or(self.sensor.steps);
        self.gain = Gain::steps(steps);
        let range = u64::from(steps) * u64::from(self.sensor.turns);
        Scale::new(self.sensor, steps, range.min(1 << 32))
    }

    /// 6509h.
    fn offset(&self, store: &Store<'_>) -> i64 {
        let offset = store.unsigned(OFFSET.index, OFFSET.sub) as u32;
        if self.profile().signed_offset {
            // An INTEGER32 comes as its 32 bits or with its sign.
            i64::from(offset as i32)
        } else {
            i64::from(offset)
        }
    }

    /// Steps that a test adds to the position.
    fn injected_offset(&self, store: &Store<'_>) -> i64 {
        let at = self.profile().object(Role::InjectedOffset);
        let at = at.filter(|_| Self::PARTS.injected_offset);
        at.map_or(0, |at| i64::from(store.unsigned(at.index, at.sub) as u32))
    }

    /// Sets 6509h and the object that shows it.
    pub(super) fn set_offset(&self, store: &mut Store<'_>, offset: i64) {
        store.set_unsigned(OFFSET, offset as u64);
        self.show_link(store, OFFSET);
    }

    /// The offset with which the position at an angle is `preset`.
    pub(super) fn offset_for(&self, angle: Angle, preset: u32) -> i64 {
        if !self.profile().signed_offset {
            return self.scale.offset_from(self.count(angle), preset).into();
        }
        // The difference as it is, unless an INTEGER32 cannot hold it.
        let range = self.scale.range() as i64;
        match i64::from(preset) - self.count(angle) as i64 {
            above if above > i64::from(i32::MAX) => above - range,
            below if below < i64::from(i32::MIN) => below + range,
            offset => offset,
        }
    }

    /// May 6002h have this value?
    pub(super) fn check_range(&self, store: &Store<'_>, value: u64) -> Result<(), AbortCode> {
        if let Some((numerator, denominator)) = self.output_gear(store) {
            return self.check_output(value, numerator, denominator);
        }
        let steps = u64::from(self.resolution(store));
        match self.profile().range_rule {
            RangeRule::Sensor if value == 0 && self.profile().zero_is_full => Ok(()),
            RangeRule::Sensor => self.between(value, 1, self.sensor.range()),
            RangeRule::PowerOfTwo if value == 0 && self.profile().zero_is_full => Ok(()),
            RangeRule::PowerOfTwo => {
                if value.is_multiple_of(steps) && (value / steps).is_power_of_two() {
                    Ok(())
                } else {
                    Err(AbortCode::ValueRange)
                }
            }
            RangeRule::Turns => {
                self.between(value, 1, steps.saturating_mul(self.sensor.turns.into()))
            }
        }
    }

    /// May an object of the gear have this value? A gear that divides nothing cannot be
    /// switched on, nor one whose 6001h the sensor does not have.
    pub(super) fn check_gear(
        &self,
        store: &Store<'_>,
        sub: u8,
        value: u64,
    ) -> Result<(), AbortCode> {
        let Some(gear) = self.profile().gear else {
            return Ok(());
        };
        if matches!(sub, 2 | 3) {
            self.between(value, 1, u32::MAX.into())?;
        }
        let factor = Factor::load(store, gear, Some((sub, value)));
        match (gear.kind, factor.ratio()) {
            (GearKind::Output, Some((numerator, denominator))) => {
                let range = self.range(store.try_unsigned(0x6002, 0));
                self.check_output(range, numerator, denominator)
            }
            _ => Ok(()),
        }
    }

    /// 6001h as an output gear makes it is one that the sensor has.
    fn check_output(&self, range: u64, numerator: u64, denominator: u64) -> Result<(), AbortCode> {
        let steps = range.saturating_mul(denominator);
        if range > 0 && steps <= u64::from(self.sensor.steps).saturating_mul(numerator) {
            Ok(())
        } else {
            Err(AbortCode::Incompatible)
        }
    }

    pub(super) fn between(&self, number: u64, low: u64, high: u64) -> Result<(), AbortCode> {
        if number > high {
            Err(AbortCode::ValueTooHigh)
        } else if number < low {
            Err(self.profile().below_limit)
        } else {
            Ok(())
        }
    }

    /// The first of two linked objects that an address is one of; else the address.
    pub(super) fn link(&self, address: Address) -> Address {
        let mut links = self.profile().links.iter();
        let link = links.find(|(_, other)| *other == address);
        link.map_or(address, |(first, _)| *first)
    }

    /// The second of two linked objects shows the first.
    pub(super) fn show_link(&self, store: &mut Store<'_>, first: Address) {
        for (from, to) in self.profile().links {
            if *from == first {
                let value = store.unsigned(from.index, from.sub);
                store.set_unsigned(*to, value);
            }
        }
    }

    /// A reset: the one of two linked objects that is saved rules; of two, the one that
    /// storage held.
    pub(super) fn agree_on_links(&self, store: &mut Store<'_>) {
        let is_saved = |store: &Store<'_>, at: Address| match store.dictionary().row_at(at) {
            Some(row) => row.group() != Group::None,
            None => false,
        };
        let is_stored = |store: &Store<'_>, at: Address| match store.dictionary().row_at(at) {
            Some(row) => row.group() != Group::None && !store.has_default(row),
            None => false,
        };
        for (first, second) in self.profile().links {
            if is_saved(store, *second) && !is_saved(store, *first)
                || is_stored(store, *second) && !is_stored(store, *first)
            {
                let value = store.unsigned(second.index, second.sub);
                store.set_unsigned(*first, value);
            }
            self.show_link(store, *first);
        }
    }
}
