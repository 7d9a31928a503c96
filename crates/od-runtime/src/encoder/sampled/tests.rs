//! A shaft whose speed is known only from samples.

use super::*;

const MS: u64 = 1_000;
const STEPS: u32 = 0x2000;

/// A shaft at some angle in each moment, and a sensor of 2¹³ steps on it.
struct Turning<F>(F);

impl<F: Fn(u64) -> f64> PositionSource for Turning<F> {
    fn sample(&mut self, now: Instant) -> Result<Angle, Fault> {
        let steps = (self.0)(now.as_micros()) * f64::from(STEPS);
        // 19 bits of a revolution are below a step.
        Ok(Angle::from_fractions((steps.floor() as i64) << 19))
    }
}

type Shaft<F> = Sampled<Turning<F>, 64>;

fn shaft<F: Fn(u64) -> f64>(turns: F, reach_ms: u32) -> Shaft<F> {
    let mut shaft = Sampled::new(Turning(turns), Duration::from_millis(1));
    shaft.look_back(reach_ms * 1000);
    shaft
}

fn ask<P: PositionSource, const N: usize>(shaft: &mut Sampled<P, N>, micros: u64) {
    shaft.angle(Instant::from_micros(micros)).unwrap();
}

/// The speed over 50 ms in steps per second.
fn speed<P: PositionSource, const N: usize>(shaft: &Sampled<P, N>, micros: u64) -> Option<i64> {
    shaft.speed(Instant::from_micros(micros), 50_000, Gain::steps(STEPS))
}

#[test]
fn an_even_speed_is_known_after_one_interval() {
    for steps_per_ms in [-100, -1, 0, 1, 3, 100] {
        let turns = move |micros| micros as f64 / 1000.0 * f64::from(steps_per_ms);
        let mut shaft = shaft(move |micros| turns(micros) / f64::from(STEPS), 50);
        for ms in 0..300 {
            ask(&mut shaft, ms * MS);
            let expected = (ms >= 50).then_some(i64::from(steps_per_ms) * 1000);
            assert_eq!(speed(&shaft, ms * MS), expected, "{steps_per_ms} {ms}");
        }
    }
}

/// Pseudo-random numbers from 0 to 1.
fn noise(mut seed: u64) -> f64 {
    for _ in 0..3 {
        seed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29) ^ 0x5DEE_CE66D;
    }
    (seed >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn a_jittering_shaft_is_within_a_step_per_interval() {
    // 1.7 revolutions per second, and up to 3 steps beside that.
    let turns = |micros: u64| {
        let jitter = (noise(micros) - 0.5) * 6.0 / f64::from(STEPS);
        1.7 * micros as f64 / 1e6 + jitter
    };
    let mut shaft = shaft(turns, 50);
    for ms in 0..1000 {
        ask(&mut shaft, ms * MS);
        if ms < 50 {
            continue;
        }
        let way = (turns(ms * MS) - turns((ms - 50) * MS)) * f64::from(STEPS);
        let error = speed(&shaft, ms * MS).unwrap() as f64 - way * 20.0;
        assert!(error.abs() <= 20.0, "{ms}: {error}");
    }
}

#[test]
fn a_host_that_is_late_does_not_change_the_speed() {
    for turns_per_second in [0.013, 0.7, -33.3] {
        let turns = move |micros: u64| turns_per_second * micros as f64 / 1e6;
        let mut shaft = shaft(turns, 50);
        let exact = turns_per_second * f64::from(STEPS);
        for ms in 0..1000 {
            let late = (noise(ms) * 900.0) as u64;
            ask(&mut shaft, ms * MS + late);
            if ms > 51 {
                let error = speed(&shaft, ms * MS + late).unwrap() as f64 - exact;
                assert!(error.abs() <= 20.0, "{ms}: {error}");
            }
        }
    }
}

#[test]
fn a_shaft_that_stops_has_no_speed_one_interval_later() {
    let mut shaft = shaft(|micros| micros.min(200 * MS) as f64 / 1e6, 50);
    for ms in 0..=250 {
        ask(&mut shaft, ms * MS);
        let is_turning = (50..250).contains(&ms);
        assert_eq!(speed(&shaft, ms * MS).unwrap_or(0) > 0, is_turning, "{ms}");
    }
    // Sixteen samples for 50 ms are at most 4 ms apart.
    let mut few: Sampled<_, 16> = Sampled::new(shaft.source, Duration::from_millis(1));
    few.look_back(50_000);
    for ms in 0..=254 {
        ask(&mut few, ms * MS);
        if (50..=200).contains(&ms) {
            let error = speed(&few, ms * MS).unwrap() - i64::from(STEPS);
            assert!(error.abs() <= 20, "{ms}: {error}");
        }
    }
    assert_eq!(speed(&few, 254 * MS), Some(0));
}

#[test]
fn an_acceleration_is_the_difference_of_two_speeds() {
    // 100 revolutions per second squared up to 0.5 s, then even.
    let turns = |micros: u64| {
        let seconds = micros as f64 / 1e6;
        let even = (seconds - 0.5).max(0.0);
        50.0 * (seconds - even).powi(2) + 50.0 * even
    };
    let mut shaft = shaft(turns, 50);
    let gain = Gain {
        multiplier: 3,
        divider: 7,
        ..Gain::steps(STEPS)
    };
    for ms in 0..700 {
        ask(&mut shaft, ms * MS);
        let now = Instant::from_millis(ms);
        let Some(found) = shaft.acceleration(now, 50_000, gain) else {
            assert!(ms < 50);
            continue;
        };
        // Two steps in 25 ms, twice.
        let unsure = 2.0 / 0.025 / 0.025 * 3.0 / 7.0 + 1.0;
        let exact = match ms {
            ..=500 => 100.0 * f64::from(STEPS) * 3.0 / 7.0,
            550.. => 0.0,
            _ => continue,
        };
        assert!((found as f64 - exact).abs() <= unsure, "{ms}: {found}");
    }
}

#[test]
fn the_fastest_and_the_finest_fit() {
    let now = Instant::from_millis(60_000);
    let mut shaft: Sampled<_, 3> = Sampled::new(Angle::ZERO, Duration::from_millis(60_000));
    shaft.look_back(60_000_000);
    ask(&mut shaft, 0);
    // 2³¹ − 1 revolutions in a minute.
    shaft.source = Angle::from_fractions(i64::MAX);
    assert_eq!(shaft.due(), Some(now));
    ask(&mut shaft, now.as_micros());
    let speed = |gain| shaft.speed(now, 60_000_000, gain).unwrap();
    assert_eq!(speed(Gain::steps(60)) >> 2, i64::from(u32::MAX >> 3));
    let most = Gain {
        multiplier: u32::MAX,
        ..Gain::steps(u32::MAX)
    };
    assert_eq!(speed(most), 1 << 62);
    assert_eq!(speed(Gain::ratio(1 << 40, u64::MAX)), 2);
    assert_eq!(speed(Gain::ratio(0, 0)), 0);
}

/// A sensor of as many bits of revolutions as its type says.
struct Wraps<const BITS: u32>(i64);

impl<const BITS: u32> PositionSource for Wraps<BITS> {
    const TURN_BITS: u32 = BITS;

    fn sample(&mut self, _: Instant) -> Result<Angle, Fault> {
        Ok(Angle::from_fractions(self.0 & ((1 << (32 + BITS)) - 1)))
    }
}

fn counts_on<const BITS: u32>() {
    let mut shaft: Sampled<Wraps<BITS>, 64> = Sampled::new(Wraps(0), Duration::from_millis(1));
    shaft.look_back(50_000);
    let third = (1 << 32) / 3;
    for (ms, way) in (0..500).chain((0..=500).rev()).enumerate() {
        shaft.source.0 = way * third;
        let angle = shaft.angle(Instant::from_millis(ms as u64)).unwrap();
        assert_eq!(angle.fractions(), way * third, "{BITS}: {ms}");
    }
    let back = speed(&shaft, 1000 * MS).unwrap();
    assert_eq!(back, -1000 * i64::from(STEPS) / 3, "{BITS}");
}

#[test]
fn a_sensor_that_starts_again_at_0_is_counted_on() {
    counts_on::<0>();
    counts_on::<1>();
    counts_on::<12>();
}

#[test]
fn a_volatile_counter_starts_within_the_first_revolution() {
    let sensor = Sensor { steps: 1, turns: 1 };
    let mut shaft: Sampled<_> = Sampled::new(Angle::ZERO, Duration::from_millis(1));
    let mut at = |ms, quarters: i64, start| {
        if start {
            shaft.start(Instant::from_millis(ms), Counter::Volatile, sensor);
        }
        shaft.source = Angle::from_fractions(quarters << 30);
        shaft.angle(Instant::from_millis(ms)).unwrap().fractions() >> 30
    };
    assert_eq!((at(0, 21, true), at(1, 25, false)), (1, 5));
    assert_eq!((at(2, -5, true), at(3, -9, false)), (3, -1));
}

#[test]
fn a_sensor_that_fails_is_asked_again_and_has_no_speed() {
    let state = core::cell::Cell::new(Ok(0));
    let sensor = |_| state.get().map(Angle::from_fractions);
    let mut shaft: Sampled<_> = Sampled::new(sensor, Duration::from_millis(1));
    shaft.look_back(50_000);
    assert_eq!(shaft.due(), Some(Instant::ZERO));
    for ms in 0..100 {
        state.set(Ok((ms << 32) / 8192));
        ask(&mut shaft, ms as u64 * MS);
    }
    let now = Instant::from_millis;
    state.set(Err(Fault::Internal));
    for ms in 100..150 {
        assert_eq!(shaft.angle(now(ms)), Err(Fault::Internal));
        assert_eq!(shaft.due(), Some(now(ms + 1)));
    }
    let acceleration = |ms| shaft.acceleration(now(ms), 50_000, Gain::steps(STEPS));
    assert_eq!(speed(&shaft, 149 * MS), Some(1000));
    assert_eq!([148, 149].map(acceleration), [Some(0); 2]);
    assert_eq!(speed(&shaft, 150 * MS), None);
    assert_eq!([150, 151].map(acceleration), [None; 2]);
    state.set(Ok((160i64 << 32) / 8192));
    ask(&mut shaft, 160 * MS);
    assert_eq!(speed(&shaft, 160 * MS), Some(1000));
    // Hours later the times of the track have wrapped, and the angles in between are not known.
    let hours = 3 * 3600 * 1000 * MS;
    ask(&mut shaft, hours);
    ask(&mut shaft, hours + MS);
    assert_eq!(speed(&shaft, hours + MS), None);
}

#[test]
fn a_shaft_without_samples_has_only_an_angle() {
    let mut shaft: Sampled<_, 0> = Sampled::new(
        Turning(|micros| micros as f64 / 1e6),
        Duration::from_millis(1),
    );
    shaft.look_back(50_000);
    for ms in 0..200 {
        ask(&mut shaft, ms * MS);
    }
    let now = Instant::from_micros(199 * MS);
    assert_eq!(
        shaft.angle(now).unwrap().fractions() >> 19,
        199 * 0x2000 / 1000
    );
    assert_eq!(speed(&shaft, 199 * MS), None);
    assert_eq!(shaft.acceleration(now, 50_000, Gain::steps(STEPS)), None);
}

/// Times of a track are microseconds modulo 2³², so a sample of that age looks new.
#[test]
fn after_a_pause_of_71_minutes_the_speed_is_unknown() {
    const AROUND: u64 = 1 << 32;
    let turning = || shaft(|micros| micros as f64 / 1e6, 50);
    let mut slept = turning();
    for ms in 0..=60 {
        ask(&mut slept, ms * MS);
    }
    assert!(speed(&slept, 60 * MS).is_some());
    ask(&mut slept, AROUND + 61 * MS);
    assert_eq!(speed(&slept, AROUND + 61 * MS), None, "nobody asked");

    let failed = core::cell::Cell::new(false);
    let sensor = |now: Instant| {
        if failed.get() {
            Err(Fault::Internal)
        } else {
            Ok(Angle::from_fractions((now.as_micros() as i64) << 12))
        }
    };
    let mut shaft: Sampled<_, 64> = Sampled::new(sensor, Duration::from_millis(1));
    shaft.look_back(50_000);
    for ms in 0..=60 {
        ask(&mut shaft, ms * MS);
    }
    failed.set(true);
    for minute in 1..=71 {
        let now = Instant::from_micros(minute * 60_000 * MS);
        assert_eq!(shaft.angle(now), Err(Fault::Internal));
    }
    failed.set(false);
    ask(&mut shaft, AROUND + 61 * MS);
    assert_eq!(speed(&shaft, AROUND + 61 * MS), None, "nobody told");
}

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
fn the_track_covers_the_requested_time() {
    for (spacing, reach) in [(1, 2), (3, 50), (10, 65_535), (7, 1000)] {
        let mut track: Track<5> = Track::new();
        track.reach(reach);
        // Across the wrap of the times.
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
