//! Speed and acceleration (CiA 406, objects 6030h and 6040h): the movement of the shaft in the
//! units of an object.

use od_model::{Address, Kind};

use super::motion::{Gain, Motion};
use super::profile::{Family, Movement, Quantity, Source};
use super::state::Encoder;
use crate::application::Context;
use crate::store::Store;
use od_wire::Instant;

impl<M: Motion, F: Family> Encoder<M, F> {
    /// Returns the speeds and accelerations of the family.
    pub(super) fn movements(
        &self,
    ) -> impl Iterator<Item = (Address, &'static Movement)> + use<M, F> {
        let movements = Self::PARTS.movement.then(|| self.profile().movements());
        movements.into_iter().flatten()
    }

    /// Starts movements again, after a start or a change of source or interval: their values are 0
    /// until a whole interval has passed.
    pub(super) fn restart_movements(
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

    /// Updates the object of a movement: the value saturates at the limits of the object's type
    /// (MANUALS.md U-15).
    pub(super) fn show_movement(
        &self,
        cx: &mut Context<'_, '_>,
        address: Address,
        movement: &Movement,
    ) {
        let Some(row) = cx.store.dictionary().row_at(address) else {
            return;
        };
        if !matches!(row.data_type().kind(), Kind::Unsigned | Kind::Signed) {
            return;
        }
        let value = self.movement(cx.store, cx.now, address, movement);
        let most = (1 << (row.bits().clamp(8, 32) - 1)) - 1;
        let value = value.unwrap_or(0).clamp(-most - 1, most);
        cx.store.set_unsigned(address, value as u64);
    }

    /// Returns a movement in the units of its object; `None` while it is not known, or if its
    /// selector has a value without a source.
    fn movement(
        &self,
        store: &Store<'_>,
        now: Instant,
        address: Address,
        movement: &Movement,
    ) -> Option<i64> {
        let mut known = self.measured_since.iter().zip(self.movements());
        let (since, _) = known.find(|(_, (at, _))| *at == address)?;
        let interval = interval(movement, store);
        if now.micros_since(*since) < interval.into() {
            return None;
        }
        let number = |at: Address| store.unsigned(at.index, at.sub);
        let (mut gain, follows_code_sequence) =
            self.source(movement, movement.selector.map(number))?;
        if let Some((multiplier, divider)) = movement.factor {
            gain.multiplier = number(multiplier) as u32;
            gain.divider = number(divider) as u32;
        }
        let value = match movement.quantity {
            Quantity::Speed => self.shaft.speed(now, interval, gain)?,
            Quantity::Acceleration => self.shaft.acceleration(now, interval, gain)?,
        };
        let is_reversed = follows_code_sequence
            && self.scale.is_reversed()
            && !self.has_option(store, |options| options.ignore_code_sequence);
        Some(if is_reversed {
            value.saturating_neg()
        } else {
            value
        })
    }

    /// Returns the units per revolution of a movement's source, and whether the code sequence
    /// applies to it. `None`: the selector has a value without a source.
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
    // The limits leave 16 bits at most.
    store.unsigned(at.index, at.sub).clamp(1, u16::MAX.into()) as u32 * 1000
}
