//! Speed and acceleration of a shaft whose angle a sensor tells, a sample at a time.

mod float;
mod track;

use super::angle::Angle;
use super::fault::Fault;
use super::motion::{Gain, Motion};
use super::position::Sensor;
use super::profile::Counter;
use float::Float;
use od_wire::{Duration, Instant};
use track::Track;

/// Sensor that tells the angle of a shaft.
///
/// A closure `FnMut(Instant) -> Result<Angle, Fault>` is one, and so is an [`Angle`] that the
/// host sets. It is asked once for each moment.
pub trait PositionSource {
    /// Revolutions after which the sensor starts again at 0, as a power of two: 0 for a
    /// singleturn, 12 for 4096 revolutions. 32: it never does.
    ///
    /// The encoder counts on past them. Between two samples the shaft must not turn by half of
    /// them or more.
    const TURN_BITS: u32 = 32;

    /// Returns the angle of the shaft at `now`, whole revolutions included.
    ///
    /// # Errors
    /// The fault that keeps the sensor from telling. It is reported as the family does, and in
    /// any case as an alarm (6503h), until a sample succeeds.
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
/// It samples the position at least every `every`, for which the node asks in its `poll_timeout`,
/// and whenever the position is read. A speed is the difference of two angles over the integration
/// time before the newest sample; an acceleration is the difference of the mean speeds in the
/// two halves of it. `N`, 3 to 255, is how many samples are remembered, 12 bytes each. Where
/// `N − 2` times `every` is less than the longest integration time, samples are left out, and
/// the angle changes evenly between two that are remembered. With 0 samples, for an encoder that shows
/// neither, speed and acceleration are never known.
///
/// ```
/// use od_runtime::encoder::{Angle, Encoder, EncoderProfile, Fault, PositionSource, Sampled};
/// use od_runtime::{Duration, Instant};
///
/// /// A singleturn of 12 bits; its driver gives `None` if the checksum is wrong.
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
    /// Time when the sensor was asked last.
    asked: Option<Instant>,
    /// Reason why it did not deliver a position then.
    fault: Option<Fault>,
    /// Whole revolutions that a volatile counter forgot.
    forgotten: i64,
    /// The next sample is within the first revolution.
    forgets: bool,
    /// The angle of the last sample, counted on; `None`: the next one says where the shaft is.
    angle: Option<i64>,
    track: Track<N>,
}

impl<P: PositionSource, const N: usize> Sampled<P, N> {
    /// A shaft that this sensor looks at, at least `every` so often (1 µs to 71 minutes).
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

    /// Takes a sample of the sensor; it may have started again at 0 since the last one.
    fn take(&mut self, now: Instant, sample: Angle) -> Angle {
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
        // The track knows times modulo 71 minutes.
        let pause = self.asked.map_or(0, |asked| now.micros_since(asked));
        if pause > 1 << 30 || self.track.age(micros(now)) > 1 << 30 {
            self.track.clear();
        }
        self.asked = Some(now);
        let sample = self.source.sample(now);
        self.fault = sample.err();
        Ok(self.take(now, sample?))
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

/// A moment as the track keeps it.
const fn micros(at: Instant) -> u32 {
    at.as_micros() as u32
}

/// Steps per revolution, and what else an object multiplies with.
fn factor(gain: Gain) -> Float {
    let factor = Float::new(gain.steps).times(Float::new(gain.multiplier.into()));
    let factor = factor.over(Float::new(gain.divider.into()));
    factor.over(Float::new(gain.revolutions))
}

/// Amount per second, from the amount in `micros` microseconds.
fn per_second(amount: Float, micros: u32) -> Float {
    amount
        .times(Float::new(1_000_000))
        .over(Float::new(micros.into()))
}

/// Result of a computation with fractions of a revolution, rounded towards zero.
fn signed(fractions: i64, compute: impl Fn(Float) -> Float) -> i64 {
    let whole = compute(Float::new(fractions.unsigned_abs()).shifted(-32)).whole();
    if fractions < 0 { -whole } else { whole }
}

#[cfg(test)]
mod tests;
