//! The last samples of an angle, oldest left out first.

use super::float::quotient;

/// Ring of samples that reaches back over the longest integration time.
///
/// Times are microseconds modulo 2³². The newest sample is replaced by the next one as long as
/// it lies less than `spacing` after the one before it, so that `N` samples are enough for any
/// time. One of none remembers nothing.
#[derive(Clone, Debug)]
pub(super) struct Track<const N: usize> {
    at: [u32; N],
    angle: [i64; N],
    spacing: u32,
    /// Index of the newest.
    newest: u8,
    len: u8,
}

impl<const N: usize> Track<N> {
    pub(super) const fn new() -> Self {
        const {
            assert!(
                N == 0 || N > 2 && N < 256,
                "a track has 3 to 255 samples, or none"
            )
        };
        Self {
            at: [0; N],
            angle: [0; N],
            spacing: 0,
            newest: 0,
            len: 0,
        }
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Remembers samples for this many microseconds.
    pub(super) fn reach(&mut self, micros: u32) {
        self.spacing = micros.div_ceil((N as u32).saturating_sub(2).max(1));
    }

    /// Returns the sample `back` places before the newest.
    fn sample(&self, back: u8) -> Option<(u32, i64)> {
        if N == 0 || back >= self.len {
            return None;
        }
        let (newest, back) = (usize::from(self.newest), usize::from(back));
        let index = if back > newest {
            newest + N - back
        } else {
            newest - back
        };
        Some((*self.at.get(index)?, *self.angle.get(index)?))
    }

    pub(super) fn add(&mut self, at: u32, angle: i64) {
        if N == 0 {
            return;
        }
        let gap = match (self.sample(0), self.sample(1)) {
            (Some((newest, _)), Some((before, _))) => newest.wrapping_sub(before),
            // The first two are always remembered.
            _ => u32::MAX,
        };
        let is_same = self.sample(0).is_some_and(|(newest, _)| newest == at);
        if gap >= self.spacing && !is_same {
            self.newest = match usize::from(self.newest) + 1 {
                index if index < N && self.len > 0 => index as u8,
                _ => 0,
            };
            if usize::from(self.len) < N {
                self.len += 1;
            }
        }
        let index = usize::from(self.newest);
        if let (Some(time), Some(place)) = (self.at.get_mut(index), self.angle.get_mut(index)) {
            (*time, *place) = (at, angle);
        }
    }

    /// Microseconds since the newest sample; 0 without any.
    pub(super) fn age(&self, now: u32) -> u32 {
        self.sample(0).map_or(0, |(at, _)| now.wrapping_sub(at))
    }

    /// Returns the angle `micros` microseconds before the newest sample; `None` if that is before
    /// the oldest.
    pub(super) fn back(&self, micros: u32) -> Option<i64> {
        let (newest, angle) = self.sample(0)?;
        let mut later = (0, angle);
        for back in 0..self.len {
            let (at, angle) = self.sample(back)?;
            let age = newest.wrapping_sub(at);
            if age == micros {
                return Some(angle);
            }
            if age > micros {
                let way = later.1.wrapping_sub(angle);
                let part = quotient(age - micros, age - later.0);
                return Some(angle.wrapping_add(scaled(way, part)));
            }
            later = (age, angle);
        }
        None
    }
}

/// A number times a fraction in units of 2⁻³², rounded down.
pub(super) fn scaled(number: i64, fraction: u32) -> i64 {
    let (high, low) = (number >> 32, number as u32);
    let low = (u64::from(low) * u64::from(fraction)) >> 32;
    (high * i64::from(fraction)).wrapping_add(low as i64)
}
