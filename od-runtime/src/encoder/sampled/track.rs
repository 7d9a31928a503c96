//! The last samples of an angle, oldest left out first.

use crate::encoder::float::quotient;

/// Ring of samples that reaches back over the longest integration time.
///
/// Times are microseconds modulo 2³². The newest sample is replaced by the next one as long as
/// it lies less than `spacing` after the one before it, so that `N` samples are enough for any
/// time.
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
        const { assert!(N > 2 && N < 256, "a track has 3 to 255 samples") };
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

    /// Samples are to be remembered for this long.
    pub(super) fn reach(&mut self, micros: u32) {
        self.spacing = micros.div_ceil(N as u32 - 2);
    }

    /// The sample so many before the newest; 0 is the newest.
    fn sample(&self, back: u8) -> Option<(u32, i64)> {
        if back >= self.len {
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

    /// The angle so many microseconds before the newest sample; `None` where that is before the
    /// oldest.
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
fn scaled(number: i64, fraction: u32) -> i64 {
    let (high, low) = (number >> 32, number as u32);
    let low = (u64::from(low) * u64::from(fraction)) >> 32;
    (high * i64::from(fraction)).wrapping_add(low as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_between_samples_change_evenly() {
        let mut track: Track<4> = Track::new();
        assert_eq!((track.back(0), track.age(77)), (None, 0));
        track.add(100, 1000);
        track.add(110, 3000);
        track.add(130, -1000);
        assert_eq!(track.age(131), 1);
        let angles = [0, 5, 20, 25, 30, 31].map(|back| track.back(back));
        let expected = [-1000, 0, 3000, 2000, 1000];
        assert_eq!(angles[..5], expected.map(Some));
        assert_eq!(angles[5], None);
        track.clear();
        assert_eq!(track.back(0), None);
    }

    #[test]
    fn it_reaches_as_far_as_it_is_told() {
        for (spacing, reach) in [(1, 2), (3, 50), (10, 65_535), (7, 1000)] {
            let mut track: Track<5> = Track::new();
            track.reach(reach);
            // Across the end of the times.
            let mut at = u32::MAX - 100;
            for step in 0..20_000i64 {
                track.add(at, step * spacing);
                assert_eq!(track.age(at), 0);
                let age = u64::from(reach).min(step as u64 * spacing as u64);
                let angle = step * spacing - age as i64;
                let back = track.back(age as u32).expect("it reaches there");
                assert!((back - angle).abs() <= 1, "{reach}: {back} {angle}");
                at = at.wrapping_add(spacing as u32);
            }
        }
    }

    #[test]
    fn a_second_sample_of_a_moment_replaces_the_first() {
        let mut track: Track<3> = Track::new();
        track.add(1, 10);
        track.add(1, 20);
        track.add(2, 30);
        assert_eq!((track.back(0), track.back(1)), (Some(30), Some(20)));
    }

    #[test]
    fn a_number_is_scaled_exactly() {
        for number in [0, 1, -1, 7 << 40, -(7 << 40) - 3, i64::MAX, i64::MIN] {
            for fraction in [0, 1, 1 << 31, u32::MAX] {
                let exact = (i128::from(number) * i128::from(fraction)) >> 32;
                assert_eq!(i128::from(scaled(number, fraction)), exact);
            }
        }
    }
}
