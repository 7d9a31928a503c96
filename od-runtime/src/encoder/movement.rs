//! Speed and acceleration: the movement of the shaft in the units of an object.

use od_model::Address;

use super::family::Family;
use super::motion::{Gain, Motion};
use super::object::{Movement, Source};
use super::rate::{KEPT, Rate, Shown};
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
        self.rates = [None; KEPT];
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

    /// The movement at an address with its handle, if its rate is kept.
    #[inline]
    pub(super) fn kept_movement(&mut self, now: Instant, address: Address) -> Option<(Shown, i64)> {
        let mut kept = self.rates.iter_mut().flatten();
        let rate = kept.find(|rate| rate.value.address() == address)?;
        let value = rate.kept(&self.shaft, now);
        Some((rate.value, value))
    }

    /// The same as the low bytes of a number.
    #[inline(never)]
    pub(super) fn kept_number(&mut self, now: Instant, address: Address) -> Option<u32> {
        let (shown, value) = self.kept_movement(now, address)?;
        Some(shown.limited(value) as u32)
    }

    /// Brings the movement at an address up to date; it is 0 while it is not known.
    pub(super) fn show_movement(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        movement: &Movement,
    ) {
        let Some(rate) = self.rate(cx.store, address, movement) else {
            return;
        };
        let value = rate.of(&self.shaft, cx.now);
        rate.value.show(cx.store, value.unwrap_or(0));
        if let Some(room) = self.rates.iter_mut().find(|rate| rate.is_none()) {
            *room = Some(rate);
        }
    }

    /// Reads the objects of a movement.
    fn rate(&self, store: &Store<'_>, address: Address, movement: &Movement) -> Option<Rate> {
        let mut known = self.measured_since.iter().zip(self.movements());
        let (since, _) = known.find(|(_, (at, _))| *at == address)?;
        let number = |at: Address| store.unsigned(at.index, at.sub);
        let source = self.source(movement, movement.selector.map(number));
        let gain = source.map(|(gain, _)| match movement.factor {
            Some((multiplier, divider)) => Gain {
                multiplier: number(multiplier) as u32,
                divider: number(divider) as u32,
                ..gain
            },
            None => gain,
        });
        Some(Rate {
            quantity: movement.quantity,
            interval: interval(movement, store),
            since: *since,
            gain,
            is_turned: source.is_some_and(|(_, has_sense)| has_sense)
                && self.scale.is_reversed()
                && !self.has_option(store, |options| options.ignore_sense),
            value: Shown::find(store, address)?,
            last: None,
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
