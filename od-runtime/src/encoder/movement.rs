//! Speed and acceleration: what the shaft's course means in the steps of an object.

use od_model::Address;

use super::course::FINE;
use super::{Encoder, Movement, Quantity, Source};
use crate::store::Store;
use od_wire::Instant;

/// How many movements of a profile are told apart.
pub(super) const MOVEMENTS: usize = 4;

/// Steps per revolution in 2⁻³² steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rate(u128);

impl Rate {
    /// So many steps in so many revolutions, 1 or more; at most 2³² a revolution.
    pub(super) const fn new(steps: u64, revolutions: u64) -> Self {
        let revolutions = if revolutions == 0 { 1 } else { revolutions };
        Self(((steps as u128) << 32) / revolutions as u128)
    }
}

impl Encoder {
    /// The source or the interval of a movement changed, or all began anew: a whole interval
    /// from `now` on nothing is known.
    pub(super) fn forget_movements(&mut self, now: Instant, which: impl Fn(&Movement) -> bool) {
        let known = self.measured_since.iter_mut().zip(self.profile.movements);
        for (since, _) in known.filter(|(_, movement)| which(movement)) {
            *since = now;
        }
    }

    /// Does the object have a part in a movement: as selector or interval?
    pub(super) fn is_movement_parameter(movement: &Movement, address: Address) -> bool {
        movement.selector == Some(address) || movement.interval == address
    }

    /// Brings the movement at an address up to date; answers whether there is one.
    pub(super) fn show_movement(
        &self,
        store: &mut Store<'_>,
        now: Instant,
        address: Address,
    ) -> bool {
        let mut movements = self.profile.movements.iter().zip(self.measured_since);
        let Some((movement, since)) = movements.find(|(movement, _)| movement.value == address)
        else {
            return false;
        };
        let Ok(entry) = store.dictionary().find(address) else {
            return false;
        };
        let bits = entry.data_type.bits().unwrap_or(32).clamp(8, 32);
        let most = (1i128 << (bits - 1)) - 1;
        let value = self.movement(store, now, movement, since);
        store.set_unsigned(address, value.clamp(-most - 1, most) as u64);
        true
    }

    fn movement(
        &self,
        store: &Store<'_>,
        now: Instant,
        movement: &Movement,
        since: Instant,
    ) -> i128 {
        let number = |at: Address| store.unsigned(at.index, at.sub);
        let interval = number(movement.interval).clamp(1, u16::MAX.into()) * 1000;
        if now.micros_since(since) < interval {
            return 0;
        }
        let Some((rate, has_sense)) = self.source(movement, movement.selector.map(number)) else {
            return 0;
        };
        let from = Instant::from_micros(now.as_micros() - interval);
        let course = self.shaft.course();
        let (interval, Rate(rate)) = (i128::from(interval), rate);
        // A way is 2³¹ × 2²⁶ at most, a difference of fine speeds 2⁵², a rate 2⁶⁴.
        let (amount, by) = match movement.quantity {
            Quantity::Speed => (course.way(from, now), 60_000 * interval),
            Quantity::Acceleration => {
                let change = course.fine_speed(now) - course.fine_speed(from);
                (change * 50, 3 * FINE * interval)
            }
        };
        let steps = nearest(amount * rate as i128, by);
        let (multiplier, divider) = match movement.factor {
            Some((multiplier, divider)) => (number(multiplier), number(divider).max(1)),
            None => (1, 1),
        };
        let factor = i128::from(multiplier as u32);
        let value = whole(nearest(steps * factor, i128::from(divider as u32)));
        let ignores_sense = self.has_option(store, |options| options.ignore_sense);
        if has_sense && self.scale.is_reversed() && !ignores_sense {
            -value
        } else {
            value
        }
    }

    /// Steps per revolution of what a movement is made of, and whether the sense of rotation
    /// counts.
    fn source(&self, movement: &Movement, selected: Option<u64>) -> Option<(Rate, bool)> {
        let mut sources = movement.sources.iter();
        let (_, source) = match selected {
            Some(selected) => sources.find(|(value, _)| u64::from(*value) == selected)?,
            None => sources.next()?,
        };
        Some(match source {
            // A revolution per minute is a sixtieth of a revolution per second.
            Source::Revolutions => (Rate::new(60, 1), true),
            Source::Position => (self.rate, true),
            Source::Fixed(steps) => (Rate::new((*steps).into(), 1), true),
            Source::Raw => (Rate::new(self.sensor.steps.into(), 1), false),
        })
    }
}

/// A division to the nearest, halves away from zero; `by` is more than 0.
const fn nearest(number: i128, by: i128) -> i128 {
    if number < 0 {
        -((by / 2 - number) / by)
    } else {
        (number + by / 2) / by
    }
}

/// Whole steps of 2⁻³² steps, towards zero. What lies less than 2⁻¹³ below a whole step is
/// that step: the fractions were rounded on the way.
const fn whole(fractions: i128) -> i128 {
    const NEARLY: i128 = 1 << 19;
    if fractions < 0 {
        -((NEARLY - fractions) >> 32)
    } else {
        (fractions + NEARLY) >> 32
    }
}
