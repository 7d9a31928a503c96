//! Angle of a shaft, whole revolutions included.

/// Angle in 2⁻³² revolutions from the zero of the sensor, counted on past a revolution.
///
/// Whole revolutions are the upper half, −2³¹ to 2³¹−1; past the ends it wraps.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Debug)]
pub struct Angle(i64);

impl Angle {
    /// Zero of the sensor.
    pub const ZERO: Self = Self(0);

    /// Angle of `fractions` 2⁻³² revolutions.
    #[inline]
    pub const fn from_fractions(fractions: i64) -> Self {
        Self(fractions)
    }

    /// Returns the angle in 2⁻³² revolutions.
    #[inline]
    pub const fn fractions(self) -> i64 {
        self.0
    }

    /// Sum of two angles.
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }

    /// Difference of two angles.
    #[must_use]
    pub const fn minus(self, other: Self) -> Self {
        Self(self.0.wrapping_sub(other.0))
    }

    /// Returns whole revolutions, rounded down, and the rest in 2⁻³² revolutions.
    #[inline]
    pub const fn split(self) -> (i64, u32) {
        (self.0 >> 32, self.0 as u32)
    }
}
