//! Interface between an encoder and the shaft that it sits on.

use super::position::{Angle, Sensor};
use super::profile::Counter;
use super::report::Fault;
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
    /// The fault that keeps the sensor from measuring. Until a call succeeds, the encoder reports
    /// an alarm (6503h, EMCY) and shows the position of the last angle.
    fn angle(&mut self, now: Instant) -> Result<Angle, Fault>;

    /// Returns the mean speed over the `interval` in microseconds before `now`: revolutions per
    /// second, times `gain`, rounded towards zero. `None`: the movement is not known that far back.
    fn speed(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64>;

    /// Returns the mean acceleration in revolutions per second squared; all else is as in
    /// [`speed`](Self::speed).
    fn acceleration(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64>;

    /// Receives the longest interval, in microseconds, for which the encoder will ask.
    fn look_back(&mut self, interval: u32) {
        let _ = interval;
    }

    /// Returns when [`angle`](Self::angle) has to be called even if no master reads the position.
    /// `None`: such a call is not needed.
    fn due(&self) -> Option<Instant> {
        None
    }

    /// Starts the electronics: at power-on and NMT reset node. A [`Counter::Volatile`] starts
    /// within the first revolution.
    fn start(&mut self, now: Instant, counter: Counter, sensor: Sensor) {
        let _ = (now, counter, sensor);
    }

    /// Switches the power off. Only a simulation continues after this.
    fn power_off(&mut self, now: Instant) {
        let _ = now;
    }
}

/// Factor from revolutions to the units of an object:
/// `steps / revolutions × multiplier / divider`. A `revolutions` or `divider` of 0 counts as 1.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Gain {
    /// Steps in [`revolutions`](Self::revolutions); at most 2³² per revolution.
    pub steps: u64,
    /// Number of revolutions that have these steps.
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

    /// Gain of `steps` in a number of `revolutions`.
    pub const fn ratio(steps: u64, revolutions: u64) -> Self {
        Self {
            steps,
            revolutions,
            multiplier: 1,
            divider: 1,
        }
    }
}
