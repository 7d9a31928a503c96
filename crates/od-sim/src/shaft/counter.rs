//! Revolution counter of an encoder, which may miss revolutions without power.

use od_runtime::encoder::{Angle, Counter, Sensor};

/// Revolutions that the counter of an encoder missed.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct Unseen {
    angle: Angle,
    /// Angle of the shaft when the power was switched off.
    off: Option<Angle>,
}

impl Unseen {
    /// A counter that missed nothing.
    pub(super) const NOTHING: Self = Self {
        angle: Angle::ZERO,
        off: None,
    };

    /// Revolutions missed since the start.
    #[inline]
    pub(super) const fn angle(&self) -> Angle {
        self.angle
    }

    /// Forgets the missed revolutions: the counter knows the angle of the shaft again.
    pub(super) fn forget(&mut self) {
        self.angle = Angle::ZERO;
    }

    /// Switches the power off with the shaft at this angle. The shaft may continue to turn; a counter that misses a
    /// zero crossing is then wrong, which shows if the number of revolutions is not a power of two.
    pub(super) fn power_off(&mut self, shaft: Angle) {
        self.off = Some(shaft.minus(self.angle));
    }

    /// Switches the power on with the shaft at this angle.
    pub(super) fn power_on(&mut self, shaft: Angle, counter: Counter, sensor: Sensor) {
        let off = self.off.take();
        let on = shaft.minus(self.angle);
        // Complete ranges that fit into the angle fit into its difference.
        let missed = match (counter, off) {
            (Counter::Volatile, _) => on.fractions() & !0xFFFF_FFFF,
            (_, None) => 0,
            (Counter::Sensor, Some(off)) => {
                let range = i128::from(sensor.turns.max(1)) << 32;
                let laps = |angle: Angle| i128::from(angle.fractions()).div_euclid(range);
                ((laps(on) - laps(off)) * range) as i64
            }
            (Counter::Kept { turns }, Some(off)) => {
                let turned = i128::from(on.minus(off).fractions());
                let (range, half) = (i128::from(turns.max(1)) << 32, i128::from(turns) << 31);
                if turned.abs() <= half {
                    0
                } else {
                    ((turned + half).div_euclid(range) * range) as i64
                }
            }
        };
        self.angle = self.angle.plus(Angle::from_fractions(missed));
    }
}
