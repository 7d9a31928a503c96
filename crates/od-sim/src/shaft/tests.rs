//! Angles, speeds, ramps, and revolutions that a counter misses without power.

use super::*;

#[test]
fn a_minute_at_one_revolution_per_minute_is_one_revolution() {
    let mut shaft = Shaft::at_rest(Angle::ZERO);
    shaft.set_milli_rpm(Instant::from_millis(5), 1000);
    assert_eq!(shaft.at(Instant::from_millis(3)), Angle::ZERO);
    let at = |ms: u64| shaft.at(Instant::from_millis(5 + ms)).fractions();
    assert_eq!(at(60_000), 1 << 32);
    assert_eq!(at(30_000), 1 << 31);
    assert_eq!(at(59_999), ((59_999u64 << 32) / 60_000) as i64);
    for milli_rpm in [1, 7, 6_000_000, i32::MAX] {
        shaft = Shaft::at_rest(Angle::ZERO);
        shaft.set_milli_rpm(Instant::ZERO, milli_rpm);
        let hour = shaft.at(Instant::from_millis(3_600_000)).fractions();
        let exact = i128::from(milli_rpm) * 60 * (1i128 << 32) / 1000;
        assert_eq!(hour, exact as i64, "{milli_rpm}");
    }
}

#[test]
fn a_divider_of_0_counts_as_1() {
    let gain = |divider| Gain {
        divider,
        ..Gain::steps(100)
    };
    let speed = |divider| exact::exact(3, 2, gain(divider));
    assert_eq!((speed(0), speed(1), speed(2)), (150, 150, 75));
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
    // From 0 to 2 revolutions per minute within a minute: one revolution.
    assert_eq!(at(&shaft, 30_000), (1 << 30, 1000));
    assert_eq!(at(&shaft, 60_000), (1 << 32, 2000));
    assert_eq!(at(&shaft, 90_000), (2 << 32, 2000));
    shaft.turn(Instant::from_millis(30_000), Angle::from_fractions(5 << 32));
    assert_eq!(at(&shaft, 60_000), (6 << 32, 2000));
    // Interrupted half way, for a stop and for another direction.
    let mut other = shaft.clone();
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

const SENSOR: Sensor = Sensor {
    steps: 0x1000,
    turns: 0x100,
};

fn turns(turns: i64) -> Angle {
    Angle::from_fractions(turns << 32)
}

/// Revolutions of the counter at power-on, after the shaft has turned from one revolution to
/// another without power.
fn counted(counter: Counter, from: i64, to: i64) -> i64 {
    let mut shaft = Shaft::default();
    shaft.start(Instant::ZERO, counter, SENSOR);
    shaft.set_angle(Instant::ZERO, turns(from));
    shaft.power_off(Instant::ZERO);
    shaft.set_angle(Instant::ZERO, turns(to));
    shaft.start(Instant::ZERO, counter, SENSOR);
    // An NMT reset node changes only a volatile counter.
    shaft.turn(Instant::ZERO, turns(1));
    shaft.turn(Instant::ZERO, turns(-1));
    shaft.seen(Instant::ZERO).split().0
}

#[test]
fn a_counter_misses_revolutions_without_power() {
    // Whole ranges of the sensor are missed, and the crossing of its zero.
    let sensor = Counter::Sensor;
    for (from, to, expected) in [
        (3, 7, 7),
        (3, 255, 255),
        (3, 256, 0),
        (3, 519, 7),
        (3, -1, 255),
        (300, 310, 310),
        (300, 3, 259),
    ] {
        assert_eq!(counted(sensor, from, to), expected, "{from} {to}");
    }
    // Half of the counter in each direction is detected.
    let kept = Counter::Kept { turns: 8 };
    for (to, expected) in [(14, 14), (15, 7), (6, 6), (5, 13), (34, 10)] {
        assert_eq!(counted(kept, 10, to), expected, "{to}");
    }
    assert_eq!(counted(Counter::Volatile, 10, 11), 0);
    assert_eq!(counted(Counter::Volatile, 10, -5), 0);
}

#[test]
fn two_ends_of_a_shaft_have_separate_counters() {
    let mut shaft = Shaft::at_rest(turns(5));
    let mut other = Shaft::default();
    shaft.start(Instant::ZERO, Counter::Volatile, SENSOR);
    assert_eq!(shaft.seen(Instant::ZERO), Angle::ZERO);
    other.follow(&shaft);
    assert_eq!(other.seen(Instant::ZERO), turns(5));
    assert_eq!(other.without_counter(), shaft.without_counter());
    // Setting a position sets the counter, too.
    shaft.set_raw(Instant::ZERO, SENSOR, 0x2800);
    assert_eq!(shaft.raw(Instant::ZERO, SENSOR), 0x2800);
    assert_eq!(shaft.seen(Instant::ZERO).split(), (2, 1 << 31));
}

#[test]
fn positions_set_one_after_another_are_a_movement() {
    let mut shaft = Shaft::default();
    shaft.look_back(50_000);
    let speed = |shaft: &Shaft, ms| {
        let now = Instant::from_millis(ms);
        shaft.speed(now, 50_000, Gain::steps(SENSOR.steps)).unwrap()
    };
    let put = |shaft: &mut Shaft, ms, raw: i64| {
        let raw = raw.rem_euclid(SENSOR.range() as i64) as u64;
        shaft.set_raw(Instant::from_millis(ms), SENSOR, raw);
    };
    // The first position is a jump, and so is one after a pause.
    put(&mut shaft, 100, 5000);
    assert_eq!(speed(&shaft, 100), 0);
    put(&mut shaft, 121, 9000);
    assert_eq!(speed(&shaft, 121), 0);
    for ms in 1..=200 {
        put(&mut shaft, 121 + ms, 9000 + 7 * ms as i64);
        let expected = 7 * ms.min(50) as i64 * 20;
        assert_eq!(speed(&shaft, 121 + ms), expected, "{ms}");
    }
    // It stops; between two positions it turned evenly.
    assert_eq!(speed(&shaft, 346), 7 * 25 * 20);
    assert_eq!(speed(&shaft, 371), 0);
    put(&mut shaft, 371, 0);
    assert_eq!(speed(&shaft, 371), 0);
    // Two positions at one moment are a jump; an even speed continues.
    shaft.set_milli_rpm(Instant::from_millis(400), 60_000);
    put(&mut shaft, 450, 100);
    put(&mut shaft, 450, 4000);
    assert_eq!(speed(&shaft, 450), i64::from(SENSOR.steps));
    put(&mut shaft, 460, 4000 + 0x1000 / 100 + 30);
    let error = speed(&shaft, 460) - (i64::from(SENSOR.steps) + 30 * 20);
    assert!(
        error.abs() <= 20,
        "a hundredth of a revolution is not a whole step: {error}"
    );
}

#[test]
fn positions_set_one_after_another_have_an_acceleration() {
    let mut shaft = Shaft::default();
    shaft.look_back(100_000);
    for ms in 0..500u64 {
        // 2000 steps per second squared.
        let raw = ms * ms / 1000;
        shaft.set_raw(Instant::from_millis(ms), SENSOR, raw);
    }
    let now = Instant::from_millis(499);
    let gain = Gain::steps(SENSOR.steps);
    let found = shaft.acceleration(now, 100_000, gain).unwrap();
    // Positions are whole steps, four of which in 50 ms squared are 1600.
    assert!((found - 2000).abs() <= 1600, "{found}");
    let later = Instant::from_millis(600);
    assert_eq!(shaft.acceleration(later, 100_000, gain), Some(0));
}
