//! Configuration of the position: its objects and the gear give a [`Scale`].

use od_model::{Address, Group};

use super::arithmetic::at_least_1;
use super::motion::{Gain, Motion};
use super::position::{Angle, Scale};
use super::profile::{Counter, Family, Gear, GearKind, RangeRule, Role, Total};
use super::state::Encoder;
use crate::store::Store;
use od_wire::AbortCode;

/// Measuring units per revolution (CiA 406, object 6001h).
pub(super) const STEPS: Address = Address::new(0x6001, 0);
/// Offset value (CiA 406, object 6509h).
pub(super) const OFFSET: Address = Address::new(0x6509, 0);

/// Bit 0 of 6000h: the position value increases counter-clockwise.
pub const REVERSED: u64 = 1 << 0;
/// Bit 2 of 6000h: 6001h and 6002h scale the position value.
pub const SCALING: u64 = 1 << 2;

/// Values of the objects of a gear.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Factor {
    is_on: bool,
    numerator: u32,
    denominator: u32,
}

impl Factor {
    /// Reads the objects; `new` replaces the value of one sub-index.
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

    /// Returns numerator and denominator if the gear is on and neither is 0.
    fn ratio(self) -> Option<(u64, u64)> {
        let is_ratio = self.is_on && self.numerator > 0 && self.denominator > 0;
        is_ratio.then_some((self.numerator.into(), self.denominator.into()))
    }
}

impl<M: Motion, F: Family> Encoder<M, F> {
    /// Returns numerator and denominator of the gear in the store, if it is of this kind and on.
    fn gear_in(&self, store: &Store<'_>, kind: GearKind) -> Option<(u64, u64)> {
        let gear = self.profile().gear.filter(|gear| gear.kind == kind)?;
        Factor::load(store, gear, None).ratio()
    }

    /// Reads a [`GearKind::Position`], which a start engages (manual 001, 4.4.6).
    pub(super) fn engage_gear(&mut self, store: &Store<'_>) {
        self.gear = self.gear_in(store, GearKind::Position);
    }

    /// Returns whether 6001h shows the quotient of an output gear (MANUALS.md U-14).
    pub(super) fn computes_resolution(&self, store: &Store<'_>) -> bool {
        self.gear_in(store, GearKind::Output).is_some()
    }

    /// Returns whether a write to this index changed a gear that is on, or was on before.
    pub(super) fn is_acting_gear(&self, store: &Store<'_>, index: u16) -> bool {
        let gear = self.profile().gear;
        let is_gear = gear.is_some_and(|gear| gear.index == index);
        is_gear && (self.output.is_some() || self.computes_resolution(store))
    }

    /// Returns 6001h; the resolution of the sensor if 6001h is 0 or missing. 1 or more.
    fn resolution(&self, store: &Store<'_>) -> u32 {
        match store.unsigned(0x6001, 0) {
            0 => self.sensor.steps.max(1),
            steps => u32::try_from(steps).unwrap_or(u32::MAX),
        }
    }

    /// Returns the range that a value of 6002h means.
    fn range(&self, value: Option<u64>) -> u64 {
        match value {
            Some(0) if self.profile().zero_is_full => 1 << 32,
            Some(0) | None => self.sensor.range(),
            Some(range) => range,
        }
    }

    /// Applies the objects for the position (CiA 406, objects 6000h to 6002h, 6509h), and updates
    /// those that follow them: 6500h shows bits of 6000h, 6001h the quotient of an output gear, 6502h
    /// the revolutions that are shown (MANUALS.md C-EAM-17).
    pub(super) fn configure(&mut self, store: &mut Store<'_>) {
        let number = |index| store.try_unsigned(index, 0);
        self.sensor = self.profile().sensor_by(number);
        let operating = store.try_unsigned(0x6000, 0).unwrap_or(SCALING);
        let range = self.range(store.try_unsigned(0x6002, 0));
        let output = self.gear_in(store, GearKind::Output);
        match (self.output, output) {
            (None, Some(_)) => self.own_steps = store.unsigned(STEPS.index, STEPS.sub),
            (Some(_), None) => {
                store.set_unsigned(STEPS, self.own_steps);
            }
            _ => {}
        }
        self.output = output;
        if let Some((numerator, denominator)) = output {
            let steps = range.saturating_mul(denominator) / at_least_1(numerator);
            // 6001h is 1 or more.
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
            // The range has 33 bits at most, the denominator and the steps of a sensor 32.
            self.gain = Gain::ratio(range.saturating_mul(denominator), numerator);
            Scale::new(self.sensor, self.sensor.steps, range).with_gear(
                range.saturating_mul(denominator),
                u64::from(self.sensor.steps).saturating_mul(numerator),
            )
        } else {
            self.gain = Gain::steps(steps);
            Scale::new(self.sensor, steps, range)
        };
        let scale = match self.gear {
            Some((numerator, denominator)) => scale.with_gear(denominator, numerator),
            // An output gear that scales counts on already.
            None if output.is_some() || self.profile().counter == Counter::Sensor => scale,
            None => scale.counting_on(),
        };
        self.scale = scale
            .with_code_sequence(operating & REVERSED != 0)
            .with_offset(self.offset(store) + self.injected_offset(store));
        let shown = operating & u64::from(self.profile().operating_bits);
        store.set_unsigned(Address::new(0x6500, 0), shown);
    }

    /// Returns the scale with scaling off (6000h, bit 2).
    fn unscaled(&mut self) -> Scale {
        let steps = self.profile().unscaled_steps.unwrap_or(self.sensor.steps);
        self.gain = Gain::steps(steps);
        let range = u64::from(steps) * u64::from(self.sensor.turns);
        Scale::new(self.sensor, steps, range.min(1 << 32))
    }

    /// Returns 6509h (CiA 406: INTEGER32; MANUALS.md C-X-13).
    fn offset(&self, store: &Store<'_>) -> i64 {
        let offset = store.unsigned(OFFSET.index, OFFSET.sub) as u32;
        if self.profile().signed_offset {
            // The store gives the bits of an INTEGER32.
            i64::from(offset as i32)
        } else {
            i64::from(offset)
        }
    }

    /// Returns the steps that a test adds to the position.
    fn injected_offset(&self, store: &Store<'_>) -> i64 {
        let at = self.profile().object(Role::InjectedOffset);
        at.map_or(0, |at| i64::from(store.unsigned(at.index, at.sub) as u32))
    }

    /// Sets 6509h and the object that is linked with it.
    pub(super) fn set_offset(&self, store: &mut Store<'_>, offset: i64) {
        store.set_unsigned(OFFSET, offset as u64);
        self.show_link(store, OFFSET);
    }

    /// Returns the offset with which the position at an angle is `preset` (CiA 406, object 6003h;
    /// MANUALS.md U-07).
    pub(super) fn offset_for(&self, angle: Angle, preset: u32) -> i64 {
        if !self.profile().signed_offset {
            return self.scale.offset_for(angle, preset).into();
        }
        // The difference itself, unless it is outside the range of an INTEGER32.
        let range = self.scale.range() as i64;
        match i64::from(preset) - self.scale.without_offset(angle) as i64 {
            above if above > i64::from(i32::MAX) => above - range,
            below if below < i64::from(i32::MIN) => below + range,
            offset => offset,
        }
    }

    /// Checks a new value of 6002h (CiA 406, total measuring range) by the rule of the family.
    pub(super) fn check_range(&self, store: &Store<'_>, value: u64) -> Result<(), AbortCode> {
        if let Some((numerator, denominator)) = self.gear_in(store, GearKind::Output) {
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

    /// Checks a new value of an object of the gear: numerator and denominator are 1 or more, and the
    /// sensor has the resolution (6001h) of an output gear that is on.
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

    /// Checks that the sensor has the resolution (6001h) of an output gear.
    fn check_output(&self, range: u64, numerator: u64, denominator: u64) -> Result<(), AbortCode> {
        let steps = range.saturating_mul(denominator);
        if range > 0 && steps <= u64::from(self.sensor.steps).saturating_mul(numerator) {
            Ok(())
        } else {
            Err(AbortCode::Incompatible)
        }
    }

    /// Checks a number against limits; below `low` the abort code is that of the family.
    pub(super) fn between(&self, number: u64, low: u64, high: u64) -> Result<(), AbortCode> {
        if number > high {
            Err(AbortCode::ValueTooHigh)
        } else if number < low {
            Err(self.profile().below_limit)
        } else {
            Ok(())
        }
    }

    /// Returns the first object of the link that an address belongs to; without a link, the address.
    pub(super) fn link(&self, address: Address) -> Address {
        let mut links = self.profile().links.iter();
        let link = links.find(|(_, other)| *other == address);
        link.map_or(address, |(first, _)| *first)
    }

    /// Copies the first of two linked objects to the second.
    pub(super) fn show_link(&self, store: &mut Store<'_>, first: Address) {
        for (from, to) in self.profile().links {
            if *from == first {
                let value = store.unsigned(from.index, from.sub);
                store.set_unsigned(*to, value);
            }
        }
    }

    /// Makes linked objects equal after a reset: the one that is saved applies, and of two that are
    /// saved the one that has another value than its default (MANUALS.md C-EAM-28).
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
