//! Speed and acceleration: the movement of the shaft in the units of an object.

use od_model::Address;

use super::family::Family;
use super::motion::{Gain, Motion};
use super::object::{Movement, Quantity, Source};
use super::state::Encoder;
use crate::application::Context;
use crate::store::Store;
use od_wire::Instant;

impl<M: Motion, F: Family> Encoder<M, F> {
    /// The movements of the family.
    #[inline]
    pub(super) fn movements(
        &self,
    ) -> impl Iterator<Item = (Address, &'static Movement)> + use<M, F> {
        let movements = Self::PARTS.movement.then(|| self.profile().movements());
        movements.into_iter().flatten()
    }

    /// Starts movements again after a start, or after a change of source or interval: for a
    /// whole interval they are not known.
    pub(super) fn forget_movements(
        &mut self,
        cx: &Context<'_, '_>,
        which: impl Fn(&Movement) -> bool,
    ) {
        let mut longest = 0;
        let movements = self.movements();
        for (since, (_, movement)) in self.measured_since.iter_mut().zip(movements) {
            if which(movement) {
                *since = cx.now;
            }
            longest = longest.max(interval(movement, cx.store));
        }
        self.shaft.look_back(longest);
    }

    /// Does the object have a part in a movement: as selector or interval?
    pub(super) fn is_movement_parameter(movement: &Movement, address: Address) -> bool {
        movement.selector == Some(address) || movement.interval == address
    }

    /// Returns the movement at an address, within the limits of its object; 0 while it is not
    /// known.
    pub(super) fn shown_movement(
        &self,
        cx: &Context<'_, '_>,
        address: Address,
        movement: &Movement,
    ) -> i64 {
        let mut known = self.measured_since.iter().zip(self.movements());
        let since = known.find(|(_, (at, _))| *at == address);
        let bits = match cx.store.dictionary().row_at(address) {
            Some(row) if row.is_variable() => 32,
            Some(row) => row.bits().clamp(8, 32),
            None => return 0,
        };
        let most = (1i64 << (bits - 1)) - 1;
        let value = since.and_then(|(since, _)| self.movement(cx.store, cx.now, movement, *since));
        value.unwrap_or(0).clamp(-most - 1, most)
    }

    /// Returns a movement in the units of its object; `None` while it is not known.
    fn movement(
        &self,
        store: &Store<'_>,
        now: Instant,
        movement: &Movement,
        since: Instant,
    ) -> Option<i64> {
        let number = |at: Address| store.unsigned(at.index, at.sub);
        let interval = interval(movement, store);
        if now.micros_since(since) < interval.into() {
            return None;
        }
        let (gain, has_sense) = self.source(movement, movement.selector.map(number))?;
        let gain = match movement.factor {
            Some((multiplier, divider)) => Gain {
                multiplier: number(multiplier) as u32,
                divider: number(divider) as u32,
                ..gain
            },
            None => gain,
        };
        let value = match movement.quantity {
            Quantity::Speed => self.shaft.speed(now, interval, gain)?,
            Quantity::Acceleration => self.shaft.acceleration(now, interval, gain)?,
        };
        let is_turned = has_sense
            && self.scale.is_reversed()
            && !self.has_option(store, |options| options.ignore_sense);
        Some(if is_turned {
            value.saturating_neg()
        } else {
            value
        })
    }

    /// Steps per revolution of what a movement is made of, and whether the sense of rotation
    /// counts. `None`: the selector has a value without a source.
    fn source(&self, movement: &Movement, selected: Option<u64>) -> Option<(Gain, bool)> {
        let mut sources = movement.sources.iter();
        let (_, source) = match selected {
            Some(selected) => sources.find(|(value, _)| u64::from(*value) == selected)?,
            None => sources.next()?,
        };
        Some(match source {
            // A revolution per minute is a sixtieth of a revolution per second.
            Source::Revolutions => (Gain::steps(60), true),
            Source::Position => (self.gain, true),
            Source::Fixed(steps) => (Gain::steps(*steps), true),
            Source::Raw => (Gain::steps(self.sensor.steps), false),
        })
    }
}

/// Returns the interval of a movement in microseconds, 1 ms to 65.535 s.
fn interval(movement: &Movement, store: &Store<'_>) -> u32 {
    let at = movement.interval;
    // The range leaves no more than 16 bits.
    store.unsigned(at.index, at.sub).clamp(1, u16::MAX.into()) as u32 * 1000
}
