//! Shaft whose angle a sensor samples: speed and acceleration are differences of samples.

use super::arithmetic::{Float, fraction, scaled};
use super::motion::{Gain, Motion};
use super::position::{Angle, Sensor};
use super::profile::Counter;
use super::report::Fault;
use od_wire::{Duration, Instant};

/// Sensor that samples the angle of a shaft.
///
/// A closure `FnMut(Instant) -> Result<Angle, Fault>` is a source, and so is an [`Angle`] that the
/// host sets. The encoder takes one sample for each moment.
pub trait PositionSource {
    /// Number of bits of the sensor's revolution counter: 0 for a singleturn, 12 for 4096
    /// revolutions, after which the sensor starts again at 0. 32: it never starts again.
    ///
    /// The encoder counts on past the end of the sensor. Between two samples the shaft must turn by
    /// less than half of the sensor's revolutions.
    const TURN_BITS: u32 = 32;

    /// Returns the angle of the shaft at `now`, whole revolutions included.
    ///
    /// # Errors
    /// The fault that keeps the sensor from measuring. Until a sample succeeds, the encoder reports it
    /// as its family does, and in any case as an alarm (6503h).
    fn sample(&mut self, now: Instant) -> Result<Angle, Fault>;
}

impl<F: FnMut(Instant) -> Result<Angle, Fault>> PositionSource for F {
    fn sample(&mut self, now: Instant) -> Result<Angle, Fault> {
        self(now)
    }
}

/// The angle that the host set last.
impl PositionSource for Angle {
    fn sample(&mut self, _: Instant) -> Result<Angle, Fault> {
        Ok(*self)
    }
}

/// Shaft whose angle is sampled.
///
/// It takes a sample at least every `every` (the `poll_timeout` of the node includes this time),
/// and whenever the position is read. A speed is the difference of two angles over the integration
/// time before the newest sample; an acceleration is the difference of the mean speeds in the
/// two halves of that time. `N`, 3 to 255, is the number of samples that are kept, 12 bytes each. If
/// `N − 2` times `every` is less than the longest integration time, some samples are not kept, and
/// the angle is interpolated between two that are. With an `N` of 0, for an encoder without speed
/// and acceleration, both are never known.
///
/// ```
/// use od_runtime::encoder::{Angle, Encoder, EncoderProfile, Fault, PositionSource, Sampled};
/// use od_runtime::{Duration, Instant};
///
/// /// Singleturn of 12 bits; its driver returns `None` if the checksum is wrong.
/// struct Sensor {
///     read: fn() -> Option<u16>,
/// }
///
/// impl PositionSource for Sensor {
///     const TURN_BITS: u32 = 0; // it starts again at 0 with each revolution
///
///     fn sample(&mut self, _: Instant) -> Result<Angle, Fault> {
///         let raw = (self.read)().ok_or(Fault::Position)?;
///         Ok(Angle::from_fractions(i64::from(raw) << 20))
///     }
/// }
///
/// let sensor = Sensor { read: || Some(0x400) };
/// let shaft: Sampled<_, 64> = Sampled::new(sensor, Duration::from_millis(1));
/// let mut encoder = Encoder::new(&EncoderProfile::CIA406, shaft);
/// # use od_runtime::encoder::Motion;
/// # let quarter = Angle::from_fractions(1 << 30);
/// # assert_eq!(encoder.shaft.angle(Instant::ZERO), Ok(quarter));
/// ```
#[derive(Clone, Debug)]
pub struct Sampled<P, const N: usize = 16> {
    /// The sensor.
    pub source: P,
    /// Microseconds between two samples, 1 or more.
    every: u32,
    /// Time of the last sample, also of one that failed.
    asked: Option<Instant>,
    /// Reason why that sample failed.
    fault: Option<Fault>,
    /// Whole revolutions that a volatile counter lost.
    forgotten: i64,
    /// The next sample starts within the first revolution.
    forgets: bool,
    /// Angle of the last sample, counted on; `None`: counting starts with the next sample.
    angle: Option<i64>,
    track: Track<N>,
}

impl<P: PositionSource, const N: usize> Sampled<P, N> {
    /// Shaft with this sensor, sampled at least every `every` (1 µs to 71 minutes).
    pub const fn new(source: P, every: Duration) -> Self {
        let micros = every.as_secs().saturating_mul(1_000_000);
        let micros = micros.saturating_add(every.subsec_micros() as u64);
        Self {
            source,
            every: match micros {
                0 => 1,
                1..=0xFFFF_FFFF => micros as u32,
                _ => u32::MAX,
            },
            asked: None,
            fault: None,
            forgotten: 0,
            forgets: false,
            angle: None,
            track: Track::new(),
        }
    }

    /// Adds a sample; the sensor may have started again at 0 since the last one. Returns the angle,
    /// counted on.
    fn add(&mut self, now: Instant, sample: Angle) -> Angle {
        let sample = sample.fractions();
        if core::mem::take(&mut self.forgets) {
            self.forgotten = sample & !0xFFFF_FFFF;
            self.angle = None;
        }
        let sample = sample.wrapping_sub(self.forgotten);
        let angle = match self.angle {
            Some(last) => {
                let unused = 32u32.saturating_sub(P::TURN_BITS);
                let turned = sample.wrapping_sub(last) << unused >> unused;
                last.wrapping_add(turned)
            }
            None => {
                self.track.clear();
                sample
            }
        };
        self.angle = Some(angle);
        self.track.add(micros(now), angle);
        Angle::from_fractions(angle)
    }
}

impl<P: PositionSource, const N: usize> Motion for Sampled<P, N> {
    fn angle(&mut self, now: Instant) -> Result<Angle, Fault> {
        if self.asked == Some(now) {
            match (self.fault, self.angle) {
                (Some(fault), _) => return Err(fault),
                (None, Some(angle)) => return Ok(Angle::from_fractions(angle)),
                (None, None) => {}
            }
        }
        // Times of the track are modulo 71 minutes.
        let pause = self.asked.map_or(0, |asked| now.micros_since(asked));
        if pause > 1 << 30 || self.track.age(micros(now)) > 1 << 30 {
            self.track.clear();
        }
        self.asked = Some(now);
        let sample = self.source.sample(now);
        self.fault = sample.err();
        Ok(self.add(now, sample?))
    }

    fn speed(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        if self.track.age(micros(now)) > interval {
            return None;
        }
        let way = self.track.back(0)?.wrapping_sub(self.track.back(interval)?);
        Some(signed(way, |way| {
            per_second(way.times(factor(gain)), interval)
        }))
    }

    fn acceleration(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        if self.track.age(micros(now)) > interval {
            return None;
        }
        let half = interval / 2;
        let middle = self.track.back(half)?;
        let second = self.track.back(0)?.wrapping_sub(middle);
        let first = middle.wrapping_sub(self.track.back(2 * half)?);
        Some(signed(second.wrapping_sub(first), |change| {
            per_second(per_second(change.times(factor(gain)), half), half)
        }))
    }

    fn look_back(&mut self, interval: u32) {
        self.track.reach(interval);
    }

    fn due(&self) -> Option<Instant> {
        Some(match self.asked {
            Some(asked) => asked.plus_micros(self.every.into()),
            None => Instant::ZERO,
        })
    }

    fn start(&mut self, _: Instant, counter: Counter, _: Sensor) {
        self.forgets = counter == Counter::Volatile;
    }

    fn power_off(&mut self, _: Instant) {
        self.asked = None;
        self.angle = None;
    }
}

/// Ring of the last samples, which reaches back over the longest integration time.
///
/// Times are microseconds modulo 2³². While the newest sample is less than `spacing` later than the
/// one before it, the next sample replaces it, so that `N` samples are enough for any time. With an
/// `N` of 0 the ring is always empty.
#[derive(Clone, Debug)]
struct Track<const N: usize> {
    at: [u32; N],
    angle: [i64; N],
    /// Least time between two samples but the newest.
    spacing: u32,
    /// Index of the newest sample.
    newest: u8,
    len: u8,
}

impl<const N: usize> Track<N> {
    const fn new() -> Self {
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

    /// Removes all samples.
    fn clear(&mut self) {
        self.len = 0;
    }

    /// Spaces the samples so that they reach back this many microseconds.
    fn reach(&mut self, micros: u32) {
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

    /// Adds a sample; one of the same time as the newest replaces it.
    fn add(&mut self, at: u32, angle: i64) {
        if N == 0 {
            return;
        }
        let gap = match (self.sample(0), self.sample(1)) {
            (Some((newest, _)), Some((before, _))) => newest.wrapping_sub(before),
            // The first two are always kept.
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

    /// Returns the microseconds since the newest sample; 0 without samples.
    fn age(&self, now: u32) -> u32 {
        self.sample(0).map_or(0, |(at, _)| now.wrapping_sub(at))
    }

    /// Returns the angle `micros` microseconds before the newest sample, interpolated between two
    /// samples; `None` if that is before the oldest.
    fn back(&self, micros: u32) -> Option<i64> {
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
                let part = fraction(age - micros, age - later.0);
                return Some(angle.wrapping_add(scaled(way, part)));
            }
            later = (age, angle);
        }
        None
    }
}

/// Returns a time as the track keeps it: microseconds modulo 2³².
const fn micros(at: Instant) -> u32 {
    at.as_micros() as u32
}

/// Returns the value of a gain.
fn factor(gain: Gain) -> Float {
    let factor = Float::new(gain.steps).times(Float::new(gain.multiplier.into()));
    let factor = factor.over(Float::new(gain.divider.into()));
    factor.over(Float::new(gain.revolutions))
}

/// Returns the amount per second, from the amount in `micros` microseconds.
fn per_second(amount: Float, micros: u32) -> Float {
    amount
        .times(Float::new(1_000_000))
        .over(Float::new(micros.into()))
}

/// Computes with the magnitude of an angle in 2⁻³² revolutions. Returns the result with the sign of
/// the angle, rounded towards zero.
fn signed(fractions: i64, compute: impl Fn(Float) -> Float) -> i64 {
    let whole = compute(Float::new(fractions.unsigned_abs()).shifted(-32)).whole();
    if fractions < 0 { -whole } else { whole }
}

#[cfg(test)]
mod tests;
