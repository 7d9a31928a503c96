//! Interface between an encoder and the shaft that it sits on.

use super::angle::Angle;
use super::fault::Fault;
use super::position::Sensor;
use super::profile::Counter;
use od_wire::Instant;

/// Angle, speed and acceleration of a shaft.
///
/// A device with a sensor implements [`PositionSource`](super::PositionSource) and uses
/// [`Sampled`](super::Sampled); a device that measures speed itself (a timer capture, say)
/// implements this trait.
pub trait Motion {
    /// Returns the angle at `now`, whole revolutions included.
    ///
    /// # Errors
    /// The fault that keeps the sensor from telling. Until a call succeeds the encoder reports
    /// an alarm (6503h, EMCY) and shows the last angle.
    fn angle(&mut self, now: Instant) -> Result<Angle, Fault>;

    /// Returns the angle at `now`, where a glance tells it: nothing keeps the sensor from it, and nothing
    /// else changes. `None`: [`angle`](Self::angle) is to be asked. It makes a simulation faster.
    #[inline]
    fn glance(&self, now: Instant) -> Option<Angle> {
        let _ = now;
        None
    }

    /// Returns the mean speed over the `interval` in microseconds before `now`: revolutions per
    /// second, times `gain`, rounded towards zero. `None`: it is not known that far back.
    fn speed(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64>;

    /// Returns the mean acceleration, in revolutions per second squared; else as
    /// [`speed`](Self::speed).
    fn acceleration(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64>;

    /// Returns a number that identifies the speed, if it did not change since `from`, and a glance shows
    /// that: what [`speed`](Self::speed) and [`acceleration`](Self::acceleration) returned for the same
    /// number, interval and gain, they would return again. `None`: they are to be asked.
    #[inline]
    fn steady(&self, from: Instant) -> Option<i32> {
        let _ = from;
        None
    }

    /// Tells the longest interval, in microseconds, that the encoder will ask for.
    fn look_back(&mut self, interval: u32) {
        let _ = interval;
    }

    /// Returns the time of the next call of [`angle`](Self::angle) that is needed even if nobody
    /// reads the position. `None`: none is needed.
    fn due(&self) -> Option<Instant> {
        None
    }

    /// The electronics start: power came, or NMT reset node. A [`Counter::Volatile`] begins
    /// within the first revolution.
    fn start(&mut self, now: Instant, counter: Counter, sensor: Sensor) {
        let _ = (now, counter, sensor);
    }

    /// Power goes. Only a simulation outlives this.
    fn power_off(&mut self, now: Instant) {
        let _ = now;
    }
}

/// Factor from revolutions to the units of an object.
///
/// `steps / revolutions × multiplier / divider`; a 0 below a line counts as 1.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Gain {
    /// Steps in as many revolutions; at most 2³² per revolution.
    pub steps: u64,
    /// Revolutions.
    pub revolutions: u64,
    /// Numerator of the object's own factor.
    pub multiplier: u32,
    /// Denominator of the object's own factor.
    pub divider: u32,
}

impl Gain {
    /// Gain of `steps` per revolution.
    pub const fn steps(steps: u32) -> Self {
        Self::ratio(steps as u64, 1)
    }

    /// Gain of `steps` in as many `revolutions`.
    pub const fn ratio(steps: u64, revolutions: u64) -> Self {
        Self {
            steps,
            revolutions,
            multiplier: 1,
            divider: 1,
        }
    }
}
