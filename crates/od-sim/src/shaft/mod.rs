//! Exact shaft: its angle, speed and acceleration are pure functions of time.

mod counter;
mod course;
mod exact;
mod placed;
mod rate;

use od_model::Dictionary;
use od_runtime::Instant;
use od_runtime::encoder::{Angle, Counter, Encoder, EncoderProfile, Fault, Gain, Motion, Sensor};

use counter::Unseen;
use course::{Course, FINE, PER_REVOLUTION, Ramp};
use exact::{even, exact};
use placed::Placed;
use rate::Rate;

/// A shaft that turns evenly, or speeds up and slows down evenly, between two changes of its
/// speed.
///
/// It turns with and without power of the encoder. Positive is clockwise, seen on
/// the encoder's flange.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Shaft {
    /// The angle at `since`.
    angle: Angle,
    /// Time of the last change.
    since: Instant,
    /// The speed at `since`, in thousandths of a revolution per minute.
    milli_rpm: i32,
    /// Change of the speed from `since` on; of length 0 without a ramp.
    ramp: Ramp,
    /// The same speed as an angle per microsecond, without a ramp.
    rate: Rate,
    /// The speeds before, from which speed and acceleration are computed.
    course: Course,
    /// Positions that a host set.
    placed: Placed,
    /// Revolutions that the counter of the encoder missed.
    unseen: Unseen,
}

impl Shaft {
    /// Shaft at rest at `angle`.
    pub const fn at_rest(angle: Angle) -> Self {
        Self {
            angle,
            since: Instant::ZERO,
            milli_rpm: 0,
            ramp: Ramp::NONE,
            rate: Rate::even(0),
            course: Course::AT_REST,
            placed: Placed::new(),
            unseen: Unseen::NOTHING,
        }
    }

    /// Returns the shaft without the state of its encoder's counter.
    #[must_use]
    pub(crate) fn without_counter(&self) -> Self {
        let unseen = Unseen::NOTHING;
        Self {
            unseen,
            ..self.clone()
        }
    }

    /// Copies angle and course of `other`, the other end of the same shaft. The counter stays.
    pub fn follow(&mut self, other: &Self) {
        let unseen = self.unseen;
        *self = Self {
            unseen,
            ..other.clone()
        };
    }

    /// Returns the angle that the electronics know: without the revolutions that the encoder
    /// missed without power.
    #[inline]
    pub fn seen(&self, now: Instant) -> Angle {
        self.at(now).minus(self.unseen.angle())
    }

    /// Returns the angle at a moment, which must not be before the last change.
    #[inline]
    pub fn at(&self, now: Instant) -> Angle {
        match self.rate.turned(now.micros_since(self.since)) {
            Some(turned) => self.angle.plus(Angle::from_fractions(turned)),
            None => self.angle_later(now),
        }
    }

    /// As [`at`](Self::at), on a ramp or days after the last change.
    #[cold]
    fn angle_later(&self, now: Instant) -> Angle {
        if self.ramp.micros != 0 {
            return self.angle_on_ramp(now);
        }
        let turned = rate::turned(self.milli_rpm, now.micros_since(self.since));
        self.angle.plus(Angle::from_fractions(turned))
    }

    fn angle_on_ramp(&self, now: Instant) -> Angle {
        let micros = now.micros_since(self.since);
        let way = self.ramp.way(self.milli_rpm, micros);
        // A distance is less than 2³² · 2⁶⁴, so 2¹²⁸ is not reached; the angle wraps.
        let turns = way.div_euclid(PER_REVOLUTION.into());
        let rest = way.rem_euclid(PER_REVOLUTION.into());
        let turned = (turns << 32) + (rest << 32) / i128::from(PER_REVOLUTION);
        self.angle.plus(Angle::from_fractions(turned as i64))
    }

    /// Returns the position of a sensor on the shaft, before scaling, code sequence and
    /// offset.
    pub fn raw(&self, now: Instant, sensor: Sensor) -> u64 {
        sensor.raw(self.seen(now))
    }

    /// Returns the speed in thousandths of a revolution per minute, positive clockwise; on a
    /// ramp, the speed at its end.
    pub const fn milli_rpm(&self) -> i32 {
        self.ramp.to(self.milli_rpm)
    }

    /// Returns `true` while the shaft turns or is on a ramp.
    pub const fn is_turning(&self) -> bool {
        self.milli_rpm != 0 || self.ramp.micros != 0
    }

    /// Sets the speed from `now` on, in thousandths of a revolution per minute.
    pub fn set_milli_rpm(&mut self, now: Instant, milli_rpm: i32) {
        self.ramp_to(now, milli_rpm, 0);
    }

    /// Changes the speed evenly from `now` on: it is `milli_rpm` after `micros` microseconds,
    /// at once with 0.
    pub fn ramp_to(&mut self, now: Instant, milli_rpm: i32, micros: u32) {
        let from = self.milli_rpm_at(now);
        self.rebase(now);
        let ramp = Ramp {
            micros,
            by: i64::from(milli_rpm) - i64::from(from),
        };
        match micros {
            0 => self.go(milli_rpm, Ramp::NONE),
            _ => self.go(from, ramp),
        }
        self.course.add(self.since, self.milli_rpm, self.ramp);
    }

    /// Returns the speed at a moment after its last change, in thousandths of a revolution per
    /// minute, rounded on a ramp.
    pub(crate) fn milli_rpm_at(&self, now: Instant) -> i32 {
        let micros = now.micros_since(self.since);
        self.ramp.speed(self.milli_rpm, micros)
    }

    /// Turns the shaft by an angle at once; it keeps its speed.
    pub fn turn(&mut self, now: Instant, by: Angle) {
        self.rebase(now);
        self.angle = self.angle.plus(by);
    }

    /// Sets the angle of the shaft; it keeps its speed.
    fn set_angle(&mut self, now: Instant, angle: Angle) {
        self.rebase(now);
        self.angle = angle;
    }

    /// Sets the shaft to the first angle at which a sensor reports `raw`; it keeps its speed.
    ///
    /// Positions that a host sets at least every 20 ms are a movement: speed and acceleration are
    /// those between the positions. A single position is a jump, which has no speed.
    pub fn set_raw(&mut self, now: Instant, sensor: Sensor, raw: u64) {
        self.place(now, sensor.angle(raw));
    }

    /// As [`set_raw`](Self::set_raw), to an angle.
    pub fn place(&mut self, now: Instant, angle: Angle) {
        self.unseen.forget();
        self.placed.add(now, angle.minus(self.at(now)));
        self.set_angle(now, angle);
    }

    /// The speed, if it was constant since `from` and no position was set.
    #[inline]
    fn even_since(&self, from: Instant) -> Option<i32> {
        let even = self.course.even_since(from);
        even.filter(|_| self.placed.is_empty())
    }

    /// Sets speed and ramp from the last change on.
    fn go(&mut self, milli_rpm: i32, ramp: Ramp) {
        (self.milli_rpm, self.ramp) = (milli_rpm, ramp);
        self.rate = match ramp.micros {
            0 => Rate::even(milli_rpm),
            _ => Rate::NONE,
        };
    }

    /// Makes `now` the last change: angle, speed and the rest of the ramp are those of now.
    fn rebase(&mut self, now: Instant) {
        let micros = now.micros_since(self.since);
        self.angle = self.at(now);
        if self.ramp.micros != 0 {
            let from = self.ramp.speed(self.milli_rpm, micros);
            let to = self.ramp.to(self.milli_rpm);
            let left = u64::from(self.ramp.micros).saturating_sub(micros);
            let ramp = match left {
                0 => Ramp::NONE,
                _ => Ramp {
                    // The rest of a ramp is not longer than the ramp.
                    micros: left as u32,
                    by: i64::from(to) - i64::from(from),
                },
            };
            self.go(from, ramp);
        }
        self.since = self.since.max(now);
    }
}

impl Motion for Shaft {
    #[inline]
    fn angle(&mut self, now: Instant) -> Result<Angle, Fault> {
        Ok(self.seen(now))
    }

    #[inline]
    fn speed(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        let from = before(now, interval);
        if let Some(milli_rpm) = self.even_since(from) {
            return Some(even(milli_rpm, gain));
        }
        let way = self.course.way(from, now) + self.placed.way(from, now);
        Some(exact(way, 60_000 * i128::from(interval), gain))
    }

    #[inline]
    fn acceleration(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        let (from, middle) = (before(now, interval), before(now, interval / 2));
        if self.even_since(from).is_some() {
            return Some(0);
        }
        let interval = i128::from(interval);
        let speed = |at| self.course.fine_speed(at);
        let placed = self.placed.way(middle, now) - self.placed.way(from, middle);
        let turned = match placed {
            0 => 0,
            placed => 4 * placed * FINE / interval,
        };
        let change = speed(now) - speed(from) + turned;
        Some(exact(change * 50, 3 * FINE * interval, gain))
    }

    fn look_back(&mut self, interval: u32) {
        self.placed.look_back(interval);
    }

    fn start(&mut self, now: Instant, counter: Counter, sensor: Sensor) {
        self.unseen.power_on(self.at(now), counter, sensor);
    }

    fn power_off(&mut self, now: Instant) {
        self.unseen.power_off(self.at(now));
    }
}

/// Returns the encoder of a family with a dictionary, at angle 0 without faults.
pub fn encoder(profile: &'static EncoderProfile, dictionary: Dictionary<'_>) -> Encoder<Shaft> {
    Encoder::new(profile, Shaft::default()).with_sensor_of(dictionary)
}

/// Returns the encoder of an unknown family, see [`EncoderProfile::for_dictionary`].
pub(crate) fn encoder_of(dictionary: Dictionary<'_>) -> Option<Encoder<Shaft>> {
    let profile = EncoderProfile::for_dictionary(dictionary)?;
    Some(Encoder::new(profile, Shaft::default()).with_sensor_of(dictionary))
}

/// The moment `micros` before `now`, but not before time 0.
const fn before(now: Instant, micros: u32) -> Instant {
    Instant::from_micros(now.as_micros().saturating_sub(micros as u64))
}

#[cfg(test)]
mod tests;
