//! Speed and acceleration: the movement of the shaft in the units of an object.

use od_model::Address;

use super::{Encoder, Gain, Motion, Movement, Quantity, Source};
use crate::application::Context;
use crate::store::Store;
use od_wire::Instant;

/// How many movements of a profile are told apart.
pub(super) const MOVEMENTS: usize = 4;

impl<M: Motion> Encoder<M> {
    /// The source or the interval of a movement changed, or all began anew: a whole interval
    /// from `now` on nothing is known.
    pub(super) fn forget_movements(
        &mut self,
        cx: &Context<'_, '_>,
        which: impl Fn(&Movement) -> bool,
    ) {
        let movements = self.profile.movements;
        let known = self.measured_since.iter_mut().zip(movements);
        for (since, _) in known.filter(|(_, movement)| which(movement)) {
            *since = cx.now;
        }
        let intervals = movements.iter().map(|of| interval(of, cx.store));
        self.shaft.look_back(intervals.max().unwrap_or(0));
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
        let most = (1i64 << (bits - 1)) - 1;
        let value = self.movement(store, now, movement, since);
        let value = value.unwrap_or(0).clamp(-most - 1, most);
        store.set_unsigned(address, value as u64);
        true
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
        let ignores_sense = self.has_option(store, |options| options.ignore_sense);
        let is_turned = has_sense && self.scale.is_reversed() && !ignores_sense;
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
