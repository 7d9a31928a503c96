//! Exact shaft: its angle, speed and acceleration are pure functions of time.

mod counter;
mod course;

use super::{Angle, Counter, Encoder, EncoderProfile, Fault, Gain, Motion, Sensor};
use counter::Unseen;
use course::{Course, FINE, Ramp};
use od_model::Dictionary;
use od_wire::Instant;

/// Thousandths of a revolution per minute, times microseconds, in one revolution.
pub(super) const PER_REVOLUTION: u64 = 60_000_000_000;

/// A shaft that turns evenly, or speeds up and slows down evenly, between two changes of its
/// speed.
///
/// It turns whether the encoder has power or not. Positive is clockwise, looking at
/// the encoder's flange.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Shaft {
    angle: Angle,
    since: Instant,
    /// At `since`.
    milli_rpm: i32,
    /// How `milli_rpm` changes from there; no time where it does not.
    ramp: Ramp,
    course: Course,
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
            course: Course::AT_REST,
            unseen: Unseen::NOTHING,
        }
    }

    /// The shaft without what an encoder's counter missed of it.
    #[must_use]
    pub fn alone(&self) -> Self {
        let unseen = Unseen::NOTHING;
        Self { unseen, ..*self }
    }

    /// Turns as `other` does, from where `other` is now: both are ends of one shaft.
    pub fn follow(&mut self, other: &Self) {
        let unseen = self.unseen;
        *self = Self { unseen, ..*other };
    }

    /// Returns the angle that the electronics know: without the revolutions that an encoder
    /// did not count while it had no power.
    #[inline]
    pub fn seen(&self, now: Instant) -> Angle {
        self.at(now).minus(self.unseen.angle())
    }

    /// Returns the angle at a moment. Before the last change it is not known any more.
    #[inline]
    pub fn at(&self, now: Instant) -> Angle {
        if self.ramp.micros != 0 {
            return self.angle_on_ramp(now);
        }
        if self.milli_rpm == 0 {
            return self.angle;
        }
        let turned = turned(self.milli_rpm.unsigned_abs(), now.micros_since(self.since));
        let turned = Angle::from_fractions(turned);
        if self.milli_rpm > 0 {
            self.angle.plus(turned)
        } else {
            self.angle.minus(turned)
        }
    }

    #[cold]
    fn angle_on_ramp(&self, now: Instant) -> Angle {
        let micros = now.micros_since(self.since);
        let way = self.ramp.way(self.milli_rpm, micros);
        // Less than 2³² · 2⁶⁴ a way, so 2¹²⁸ is not reached; the angle wraps.
        let turns = way.div_euclid(PER_REVOLUTION.into());
        let rest = way.rem_euclid(PER_REVOLUTION.into());
        let turned = (turns << 32) + (rest << 32) / i128::from(PER_REVOLUTION);
        self.angle.plus(Angle::from_fractions(turned as i64))
    }

    /// The speed that it has, or on a ramp will have at its end, in thousandths of a
    /// revolution per minute, positive clockwise.
    pub const fn milli_rpm(&self) -> i32 {
        self.ramp.to(self.milli_rpm)
    }

    /// Does it turn, or will it before its ramp ends?
    pub const fn is_turning(&self) -> bool {
        self.milli_rpm != 0 || self.ramp.micros != 0
    }

    /// From `now` on it turns with this speed, in thousandths of a revolution per minute.
    pub fn set_milli_rpm(&mut self, now: Instant, milli_rpm: i32) {
        self.ramp_to(now, milli_rpm, 0);
    }

    /// From `now` on its speed changes evenly, and is `milli_rpm` after this many
    /// microseconds; with 0 it has it at once.
    pub fn ramp_to(&mut self, now: Instant, milli_rpm: i32, micros: u32) {
        let from = self.milli_rpm_at(now);
        self.rebase(now);
        let ramp = Ramp {
            micros,
            by: i64::from(milli_rpm) - i64::from(from),
        };
        self.milli_rpm = if micros == 0 { milli_rpm } else { from };
        self.ramp = if micros == 0 { Ramp::NONE } else { ramp };
        self.course.add(self.since, self.milli_rpm, self.ramp);
    }

    /// The speed at a moment since the last change of it, as [`milli_rpm`](Self::milli_rpm)
    /// gives it, rounded to whole thousandths on a ramp.
    pub fn milli_rpm_at(&self, now: Instant) -> i32 {
        let micros = now.micros_since(self.since);
        self.ramp.speed(self.milli_rpm, micros)
    }

    /// Turns it by hand; it goes on with its speed.
    pub fn turn(&mut self, now: Instant, by: Angle) {
        self.rebase(now);
        self.angle = self.angle.plus(by);
    }

    /// Puts it somewhere; it goes on with its speed.
    pub fn set_angle(&mut self, now: Instant, angle: Angle) {
        self.rebase(now);
        self.angle = angle;
    }

    /// Puts the shaft at an angle that the electronics know in full; it goes on with its speed.
    fn set_seen(&mut self, now: Instant, angle: Angle) {
        self.unseen.forget();
        self.set_angle(now, angle);
    }

    /// The last change is `now`: angle, speed and what is left of the ramp are those of now.
    fn rebase(&mut self, now: Instant) {
        let micros = now.micros_since(self.since);
        self.angle = self.at(now);
        if self.ramp.micros != 0 {
            let from = self.ramp.speed(self.milli_rpm, micros);
            let to = self.ramp.to(self.milli_rpm);
            let left = u64::from(self.ramp.micros).saturating_sub(micros);
            self.milli_rpm = from;
            self.ramp = if left == 0 {
                Ramp::NONE
            } else {
                Ramp {
                    // What is left is not more than what there was.
                    micros: left as u32,
                    by: i64::from(to) - i64::from(from),
                }
            };
        }
        self.since = self.since.max(now);
    }
}

impl Motion for Shaft {
    #[inline]
    fn angle(&mut self, now: Instant) -> Result<Angle, Fault> {
        Ok(self.seen(now))
    }

    fn speed(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        let way = self.course.way(before(now, interval), now);
        Some(exact(way, 60_000 * i128::from(interval), gain))
    }

    fn acceleration(&self, now: Instant, interval: u32, gain: Gain) -> Option<i64> {
        let speed = |at| self.course.fine_speed(at);
        let change = speed(now) - speed(before(now, interval));
        Some(exact(change * 50, 3 * FINE * i128::from(interval), gain))
    }

    fn start(&mut self, now: Instant, counter: Counter, sensor: Sensor) {
        self.unseen.power_on(self.at(now), counter, sensor);
    }

    fn power_off(&mut self, now: Instant) {
        self.unseen.power_off(self.at(now));
    }
}

/// What only the exact shaft can tell of an encoder: its angle does not depend on when it is
/// asked for.
impl Encoder<Shaft> {
    /// An encoder at angle 0, nothing broken, switches at 0.
    pub const fn new(profile: &'static EncoderProfile) -> Self {
        Self::on(Shaft::at_rest(Angle::ZERO), profile)
    }

    /// An encoder of an unknown family, see [`EncoderProfile::for_dictionary`].
    pub fn for_dictionary(dictionary: Dictionary<'_>) -> Option<Self> {
        let profile = EncoderProfile::for_dictionary(dictionary)?;
        Some(Self::new(profile).with_sensor_of(dictionary))
    }

    /// Returns the angle that the electronics know.
    pub fn angle(&self, now: Instant) -> Angle {
        self.shaft.seen(now)
    }

    /// Returns the position as 6004h has it.
    pub fn position(&self, now: Instant) -> u32 {
        self.scale().position(self.angle(now))
    }

    /// Returns the sensor's own position, before scaling, sense of rotation and offset.
    pub fn raw_position(&self, now: Instant) -> u64 {
        self.sensor().raw(self.angle(now))
    }

    /// Puts the shaft where the sensor begins to say `raw`; it goes on with its speed.
    ///
    /// The [`sensor`](Self::sensor) has to be known.
    pub fn set_raw_position(&mut self, now: Instant, raw: u64) {
        let angle = self.sensor().angle(raw);
        self.shaft.set_seen(now, angle);
    }
}

/// The moment `micros` before `now`, the origin at the earliest.
const fn before(now: Instant, micros: u32) -> Instant {
    Instant::from_micros(now.as_micros().saturating_sub(micros as u64))
}

/// `amount / by` revolutions, times a gain, in whole units; rounded towards zero.
fn exact(amount: i128, by: i128, gain: Gain) -> i64 {
    // An amount is 2⁵⁷ at most (a way, or a difference of fine speeds), a rate 2⁶⁴.
    let rate = (u128::from(gain.steps) << 32) / u128::from(gain.revolutions.max(1));
    let steps = nearest(amount * rate as i128, by);
    let factor = i128::from(gain.multiplier);
    let value = whole(nearest(steps * factor, gain.divider.max(1).into()));
    value.clamp(i64::MIN.into(), i64::MAX.into()) as i64
}

/// 2⁻³² revolutions in `micros` at this speed: exact to 2⁻²⁸, rounded down.
#[inline]
fn turned(milli_rpm: u32, micros: u64) -> i64 {
    // 60·10⁹ is less than 2³⁶, so its remainders have room for 28 more bits.
    match u64::from(milli_rpm).checked_mul(micros) {
        Some(way) => {
            let (turns, rest) = (way / PER_REVOLUTION, way % PER_REVOLUTION);
            (turns << 32 | ((rest << 28) / PER_REVOLUTION) << 4) as i64
        }
        None => long_way(milli_rpm, micros),
    }
}

#[cold]
fn long_way(milli_rpm: u32, micros: u64) -> i64 {
    let way = u128::from(milli_rpm) * u128::from(micros);
    // Revolutions past 2³² do not matter: the angle wraps there.
    let turns = (way / u128::from(PER_REVOLUTION)) as u64;
    let rest = (way % u128::from(PER_REVOLUTION)) as u64;
    (turns << 32 | ((rest << 28) / PER_REVOLUTION) << 4) as i64
}

/// A division to the nearest, halves away from zero; `by` is more than 0.
const fn nearest(number: i128, by: i128) -> i128 {
    if number < 0 {
        -((by / 2 - number) / by)
    } else {
        (number + by / 2) / by
    }
}

/// Whole steps of 2⁻³² steps, towards zero. What lies less than 2⁻¹³ below a whole step is
/// that step: the fractions were rounded on the way.
const fn whole(fractions: i128) -> i128 {
    const NEARLY: i128 = 1 << 19;
    if fractions < 0 {
        -((NEARLY - fractions) >> 32)
    } else {
        (fractions + NEARLY) >> 32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_at_one_revolution_per_minute_is_one_revolution() {
        let mut shaft = Shaft::at_rest(Angle::ZERO);
        shaft.set_milli_rpm(Instant::from_millis(5), 1000);
        assert_eq!(shaft.at(Instant::from_millis(3)), Angle::ZERO);
        let at = |ms: u64| shaft.at(Instant::from_millis(5 + ms)).fractions();
        assert_eq!(at(60_000), 1 << 32);
        assert_eq!(at(30_000), 1 << 31);
        assert_eq!(at(59_999), (((59_999u64 << 28) / 60_000) << 4) as i64);
        for milli_rpm in [1, 7, 6_000_000, i32::MAX] {
            shaft = Shaft::at_rest(Angle::ZERO);
            shaft.set_milli_rpm(Instant::ZERO, milli_rpm);
            let hour = shaft.at(Instant::from_millis(3_600_000)).fractions();
            let exact = i128::from(milli_rpm) * 60 * (1i128 << 32) / 1000;
            assert!(
                (i128::from(hour) - i128::from(exact as i64)).abs() < 16,
                "{milli_rpm}"
            );
        }
    }

    #[test]
    fn it_stops_where_it_is_and_turns_back() {
        let mut shaft = Shaft::at_rest(Angle::from_fractions(77));
        shaft.set_milli_rpm(Instant::ZERO, 60_000);
        shaft.set_milli_rpm(Instant::from_millis(500), 0);
        let half = Angle::from_fractions(77 + (1 << 31));
        assert_eq!(shaft.at(Instant::from_millis(9_000)), half);
        shaft.set_milli_rpm(Instant::from_millis(9_000), -60_000);
        assert_eq!(shaft.at(Instant::from_millis(9_500)).fractions(), 77);
        assert_eq!(
            shaft.at(Instant::from_millis(10_000)).split(),
            (-1, (1u32 << 31) + 77)
        );
        shaft.turn(Instant::from_millis(9_500), Angle::from_fractions(1 << 30));
        assert_eq!(
            shaft.at(Instant::from_millis(9_500)).fractions(),
            77 + (1 << 30)
        );
    }

    #[test]
    fn a_ramp_ends_where_it_should_and_can_be_left() {
        let minute = 60_000_000;
        let mut shaft = Shaft::at_rest(Angle::ZERO);
        assert!(!shaft.is_turning());
        shaft.ramp_to(Instant::ZERO, 2000, minute);
        assert!(shaft.is_turning());
        let at = |shaft: &Shaft, ms: u64| {
            let now = Instant::from_millis(ms);
            (shaft.at(now).fractions(), shaft.milli_rpm_at(now))
        };
        // From 0 to 2 revolutions a minute within a minute: one revolution.
        assert_eq!(at(&shaft, 30_000), (1 << 30, 1000));
        assert_eq!(at(&shaft, 60_000), (1 << 32, 2000));
        assert_eq!(at(&shaft, 90_000), (2 << 32, 2000));
        shaft.turn(Instant::from_millis(30_000), Angle::from_fractions(5 << 32));
        assert_eq!(at(&shaft, 60_000), (6 << 32, 2000));
        // Left half way, for a stop and for another direction.
        let mut other = shaft;
        other.set_milli_rpm(Instant::from_millis(45_000), 0);
        assert!(!other.is_turning());
        assert_eq!(at(&other, 99_000), at(&other, 45_000));
        shaft.ramp_to(Instant::from_millis(60_000), -2000, minute);
        assert_eq!(at(&shaft, 90_000), ((6 << 32) + (1 << 31), 0));
        assert_eq!(at(&shaft, 120_000), (6 << 32, -2000));
        assert_eq!(at(&shaft, 150_000), (5 << 32, -2000));
    }

    #[test]
    fn no_ramp_is_too_steep_or_too_long() {
        for (from, to) in [(i32::MIN, i32::MAX), (i32::MAX, i32::MIN)] {
            for micros in [1, u32::MAX] {
                let mut shaft = Shaft::at_rest(Angle::ZERO);
                shaft.set_milli_rpm(Instant::ZERO, from);
                shaft.ramp_to(Instant::ZERO, to, micros);
                let end = Instant::from_micros(micros.into());
                assert_eq!(shaft.milli_rpm_at(end), to);
                assert_eq!(shaft.milli_rpm_at(Instant::MAX), to);
                let _ = shaft.at(Instant::MAX);
                shaft.turn(Instant::MAX, Angle::ZERO);
                assert_eq!(shaft.milli_rpm(), to);
            }
        }
    }

    #[test]
    fn the_long_way_is_the_short_way() {
        for (milli_rpm, micros) in [(1, 1), (6_000_000, 123_456_789), (u32::MAX, 1 << 31)] {
            assert_eq!(long_way(milli_rpm, micros), turned(milli_rpm, micros));
        }
        // Three hundred thousand years at full speed, and no panic.
        let _ = turned(u32::MAX, u64::MAX);
    }
}
