//! A speed or an acceleration with what its objects say, as a reading needs it.

use od_model::Kind;
use od_model::typed::{Ro, Var};

use super::motion::{Gain, Motion};
use super::object::Quantity;
use super::profile::MOVEMENTS;
use crate::device::ROOMY;
use crate::store::Store;
use od_model::Address;
use od_wire::Instant;

/// Rates that an encoder keeps until an object changes. A microcontroller reads the objects each time,
/// and saves their memory.
pub(super) const KEPT: usize = if ROOMY { MOVEMENTS } else { 0 };

/// A movement as it is computed now.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rate {
    pub(super) quantity: Quantity,
    /// Mean over this time, in microseconds.
    pub(super) interval: u32,
    /// Since when it can be measured.
    pub(super) since: Instant,
    /// `None`: the selector has a value without a source.
    pub(super) gain: Option<Gain>,
    /// Counts the other way round.
    pub(super) is_turned: bool,
    pub(super) value: Shown,
    /// Its last value, and the number of the [steady](Motion::steady) speed that it was of.
    pub(super) last: Option<(i32, i64)>,
}

impl Rate {
    /// As [`of`](Self::of), where it is not computed again while the speed is the same; 0 while it is not
    /// known.
    #[inline]
    pub(super) fn kept(&mut self, shaft: &impl Motion, now: Instant) -> i64 {
        let interval = self.interval.into();
        let from = Instant::from_micros(now.as_micros().saturating_sub(interval));
        let steady = match now.micros_since(self.since) < interval {
            true => None,
            false => shaft.steady(from),
        };
        match (steady, self.last) {
            (Some(speed), Some((last, value))) if speed == last => value,
            _ => self.computed(shaft, now, steady),
        }
    }

    #[inline(never)]
    fn computed(&mut self, shaft: &impl Motion, now: Instant, steady: Option<i32>) -> i64 {
        let value = self.of(shaft, now).unwrap_or(0);
        self.last = steady.map(|speed| (speed, value));
        value
    }

    /// Returns the movement in the units of its object; `None` while it is not known.
    #[inline]
    pub(super) fn of(&self, shaft: &impl Motion, now: Instant) -> Option<i64> {
        if now.micros_since(self.since) < self.interval.into() {
            return None;
        }
        let value = match self.quantity {
            Quantity::Speed => shaft.speed(now, self.interval, self.gain?)?,
            Quantity::Acceleration => shaft.acceleration(now, self.interval, self.gain?)?,
        };
        Some(if self.is_turned {
            value.saturating_neg()
        } else {
            value
        })
    }
}

/// The object that shows a movement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    var: Var<i64, Ro>,
    most: i64,
}

impl Shown {
    /// Looks the object up; `None` if it is not an integer.
    pub(super) fn find(store: &Store<'_>, address: Address) -> Option<Self> {
        let row = store.dictionary().row_at(address)?;
        let is_integer = matches!(row.data_type().kind(), Kind::Unsigned | Kind::Signed);
        is_integer.then(|| Self {
            var: Var::new(address, row.slot(&[]), row.bits()),
            most: (1 << (row.bits().clamp(8, 32) - 1)) - 1,
        })
    }

    #[inline]
    pub(super) const fn address(&self) -> Address {
        self.var.address()
    }

    /// A number within the limits of the object.
    #[inline]
    pub(super) fn limited(&self, number: i64) -> i64 {
        number.clamp(-self.most - 1, self.most)
    }

    /// Shows a number, within the limits of the object.
    #[inline]
    pub(super) fn show(&self, store: &mut Store<'_>, number: i64) {
        store.set(self.var, self.limited(number));
    }
}
