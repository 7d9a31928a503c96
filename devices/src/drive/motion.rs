//! Ramps: position and speed from one step to the next.
//!
//! A position is in millionths of a user unit, a speed in millionths of a user unit per second, so
//! a step of whole microseconds has exact products. Accelerations are in units per second².

use super::STEP;

/// Millionths in a unit.
pub(super) const UNIT: i64 = 1_000_000;

/// Position and speed of a demand, or of a shaft.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    /// In millionths of a unit.
    pub(super) position: i64,
    /// In millionths of a unit per second.
    pub(super) speed: i64,
}

/// Limits of a movement: speed, acceleration, deceleration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// In millionths of a unit per second.
    pub(super) speed: i64,
    pub(super) acceleration: i64,
    pub(super) deceleration: i64,
}

impl Motion {
    /// A motion at rest at 0.
    pub(super) const ZERO: Self = Self {
        position: 0,
        speed: 0,
    };

    /// Moves by one step with the present speed.
    pub(super) fn go(&mut self) {
        let way = self.speed * STEP as i64 / UNIT;
        self.position = self.position.saturating_add(way);
    }

    /// Changes the speed towards a target by one step, and moves.
    pub(super) fn ramp(&mut self, target: i64, limits: Limits) {
        let target = within(target, limits.speed);
        let is_slower =
            target.abs() < self.speed.abs() || target.signum() * self.speed.signum() < 0;
        let rate = if is_slower {
            limits.deceleration
        } else {
            limits.acceleration
        };
        let most = rate.max(1) * STEP as i64;
        let change = target - self.speed;
        // Down to speed 0 with the deceleration; the acceleration begins with the next step.
        if self.speed != 0 && target.signum() * self.speed.signum() < 0 && change.abs() > most {
            let slower = self.speed.abs() - most;
            self.speed = slower.max(0) * self.speed.signum();
        } else {
            self.speed += within(change, most);
        }
        self.go();
    }

    /// Reduces the speed towards 0 by one step, and moves.
    pub(super) fn stop(&mut self, deceleration: i64) {
        let limits = Limits {
            speed: i64::MAX,
            acceleration: deceleration,
            deceleration,
        };
        self.ramp(0, limits);
    }

    /// Approaches a position by one step, so that the motion stops there. Returns whether it has
    /// arrived.
    pub(super) fn approach(&mut self, target: i64, limits: Limits) -> bool {
        let way = target - self.position;
        let step = limits.deceleration.max(1) * STEP as i64;
        // The distance of one step at the speed of one step: below it the position is set to the
        // target.
        let near = (step * STEP as i64 / UNIT).max(1);
        if way.abs() <= near && self.speed.abs() <= 2 * step {
            self.position = target;
            self.speed = 0;
            return true;
        }
        let fastest = stopping_speed(way.unsigned_abs(), limits.deceleration);
        let wanted = fastest.min(limits.speed) * way.signum();
        self.ramp(wanted, limits);
        false
    }
}

/// The number, or the nearest one that is not beyond `most` in either direction.
pub(super) const fn within(number: i64, most: i64) -> i64 {
    if number > most {
        most
    } else if number < -most {
        -most
    } else {
        number
    }
}

/// Speed, in millionths of a unit per second, from which a deceleration in whole steps stops within
/// a distance in millionths of a unit: v²/2a + v·t = distance.
fn stopping_speed(way: u64, deceleration: i64) -> i64 {
    let deceleration = deceleration.max(1) as u64;
    // In thousandths of a unit per second, so that the square has the unit of twice the
    // deceleration times the distance.
    let step = deceleration * STEP / 1000;
    let square = (2 * deceleration)
        .checked_mul(way)
        .and_then(|square| square.checked_add(step * step));
    let speed = match square {
        Some(square) => (square.isqrt() - step) * 1000,
        // For a long distance: in whole units.
        None => {
            let way = way / UNIT as u64;
            (2 * deceleration).saturating_mul(way).isqrt() * UNIT as u64
        }
    };
    i64::try_from(speed).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        speed: 100_000 * UNIT,
        acceleration: 1_000_000,
        deceleration: 500_000,
    };

    /// In every step to a target, acceleration and speed stay within the limits, and the position
    /// does not overshoot.
    #[test]
    fn a_way_keeps_its_limits_and_ends_at_the_target() {
        for way in [1, 7, 100, 9_999, 100_000, -3, -123_456, 40_000_000] {
            let (mut motion, mut steps) = (Motion::ZERO, 0);
            let target = way * UNIT;
            loop {
                let before = motion.speed;
                let arrived = motion.approach(target, LIMITS);
                steps += 1;
                assert!(steps < 500_000, "{way} does not arrive: {motion:?}");
                if arrived {
                    assert!(
                        before.abs() <= 2 * LIMITS.deceleration * 1000,
                        "{way}: {before}"
                    );
                    break;
                }
                assert!(motion.speed.abs() <= LIMITS.speed, "{way}");
                let change = (motion.speed - before).abs();
                assert!(change <= LIMITS.acceleration * 1000, "{way}: {change}");
                let left = (target - motion.position) * way.signum();
                assert!(left >= -UNIT, "{way}: beyond by {left}");
            }
            assert_eq!((motion.position, motion.speed), (target, 0));
        }
    }

    #[test]
    fn a_ramp_has_the_expected_duration() {
        let mut motion = Motion::ZERO;
        for _ in 0..100 {
            motion.ramp(LIMITS.speed, LIMITS);
        }
        // 1,000,000 units/s² for 0.1 s, half of speed times time.
        assert_eq!(motion.speed, 100_000 * UNIT);
        assert_eq!(motion.position / UNIT, 5050);
        for _ in 0..200 {
            motion.stop(500_000);
        }
        assert_eq!(motion.speed, 0);
        assert_eq!(motion.position / UNIT, 5050 + 9950);
    }
}
