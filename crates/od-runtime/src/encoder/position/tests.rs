//! Positions at the edges, and against big integers.

use super::*;

const MULTIVO: Sensor = Sensor {
    steps: 0x2000,
    turns: 0x1_0000,
};
const SINGLE: Sensor = Sensor {
    steps: 0x2000,
    turns: 1,
};

fn check(scale: Scale, sensor: Sensor, raw: u64, expected: u32) {
    assert_eq!(
        scale.position(sensor.angle(raw)),
        expected,
        "{scale:?} at {raw}"
    );
}

#[test]
fn the_trace_of_the_manual() {
    let rest = MULTIVO.angle(0x7_9592);
    assert_eq!(MULTIVO.raw(rest), 0x7_9592);
    assert_eq!(Scale::unscaled(MULTIVO).position(rest), 0x7_9592);
    let scale = Scale::new(MULTIVO, 0x1000, 0x1000_0000);
    assert_eq!(scale.position(rest), 0x3_CAC9);
    let offset = scale.offset_for(rest, 0);
    assert_eq!(offset, 0x1000_0000 - 0x3_CAC9);
    assert_eq!(scale.with_offset(offset.into()).position(rest), 0);
    assert_eq!(
        scale.with_offset(-0x3_CAC9).position(rest),
        0,
        "a signed one"
    );
}

#[test]
fn a_sensor_without_steps_or_turns_has_one_angle() {
    for (steps, turns) in [(0, 1), (1, 0), (0, 0)] {
        let sensor = Sensor { steps, turns };
        assert_eq!(sensor.angle(5), Angle::ZERO, "{steps} {turns}");
    }
}

#[test]
fn the_code_sequence_comes_before_the_offset() {
    let scale = Scale::new(MULTIVO, 0x2000, 0x2000_0000).with_code_sequence(true);
    check(scale, MULTIVO, 0, 0);
    check(scale, MULTIVO, 1, 0x1FFF_FFFF);
    check(scale, MULTIVO, 0x1FFF_FFFF, 1);
    check(scale.with_offset(5), MULTIVO, 1, 4);
    let angle = MULTIVO.angle(1000);
    let offset = scale.offset_for(angle, 7);
    check(scale.with_offset(offset.into()), MULTIVO, 1000, 7);
    check(scale.with_offset(offset.into()), MULTIVO, 1001, 6);
}

#[test]
fn ranges_up_to_two_to_the_thirty_second() {
    let plus = Sensor {
        steps: 0x4_0000,
        turns: 0x2000,
    };
    check(Scale::unscaled(plus), plus, 0x7FFF_FFFF, 0x7FFF_FFFF);
    check(Scale::unscaled(plus), plus, 0x8000_0000, 0);
    let eam = Sensor {
        steps: 0x4000,
        turns: 0x4_0000,
    };
    assert_eq!(Scale::unscaled(eam).range(), 1 << 32);
    check(Scale::unscaled(eam), eam, 0xFFFF_FFFF, 0xFFFF_FFFF);
    check(
        Scale::unscaled(eam).with_code_sequence(true),
        eam,
        1,
        0xFFFF_FFFF,
    );
    check(Scale::unscaled(eam).with_offset(1), eam, 0xFFFF_FFFF, 0);
    check(Scale::unscaled(eam).with_offset(-1), eam, 0, 0xFFFF_FFFF);
    let odd = Scale::new(eam, 0x4000, 0xFFFF_FFFF);
    check(odd, eam, 0xFFFF_FFFF, 0);
    check(odd.with_code_sequence(true), eam, 1, 0xFFFF_FFFE);
    let large = Sensor {
        steps: 0x20_0000,
        turns: 0x1_0000,
    };
    check(Scale::unscaled(large), large, 0x1F_FFFF_FFFF, 0xFFFF_FFFF);
}

#[test]
fn a_singleturn_starts_again_at_0_and_a_multiturn_continues() {
    let turn = |turns: i64| Angle::from_fractions(turns << 32 | 1 << 31);
    let scale = Scale::new(SINGLE, 1000, 0x2000);
    assert_eq!(scale.position(turn(0)), 500);
    assert_eq!(scale.position(turn(7)), 500);
    assert_eq!(scale.position(turn(-7)), 500);
    let scale = Scale::new(SINGLE, 0x2000, 3000);
    assert_eq!(scale.position(turn(5)), 4096 % 3000);
    // Three revolutions, past the 65,536 of the sensor and below zero.
    let scale = Scale::new(MULTIVO, 1000, 3000);
    assert_eq!(scale.position(turn(2)), 2500);
    assert_eq!(scale.position(turn(65_535)), 500);
    assert_eq!(scale.position(turn(65_536)), 1500);
    assert_eq!(scale.position(turn(-1)), 2500);
    // More revolutions than the sensor has: it starts again where the sensor does.
    let scale = Scale::new(MULTIVO, 0x1000, 0x2000_0000);
    assert_eq!(scale.position(turn(65_535)), 0x0FFF_F800);
    assert_eq!(scale.position(turn(65_536)), 0x800);
}

/// Rounds down wherever it rounds, and never leaves the range.
#[test]
fn the_same_as_with_big_integers() {
    let mut random = 0x9E37_79B9_7F4A_7C15u64;
    let mut next = move || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        random
    };
    for _ in 0..200_000 {
        let sensor = Sensor {
            steps: (next() as u32 >> (next() % 31)).max(1),
            turns: 1 << (next() % 19),
        };
        let steps = (next() as u32 >> (next() % 32)).max(1);
        let range = (next() >> (32 + next() % 32)) + 1;
        let (reversed, offset) = (next() & 1 == 1, next() as i32);
        let raw = next() % sensor.range();
        let angle = sensor.angle(raw);
        assert_eq!(sensor.raw(angle), raw);
        let scale = Scale::new(sensor, steps, range)
            .with_code_sequence(reversed)
            .with_offset(offset.into());
        let turn = i128::from(raw / u64::from(sensor.steps));
        let step = i128::from(raw % u64::from(sensor.steps));
        let mut p = turn * i128::from(steps) + step * i128::from(steps) / i128::from(sensor.steps);
        p %= i128::from(range);
        if reversed {
            p = (i128::from(range) - p) % i128::from(range);
        }
        p = (p + i128::from(offset)).rem_euclid(i128::from(range));
        assert_eq!(i128::from(scale.position(angle)), p, "{scale:?} {raw}");
        let target = (next() % range) as u32;
        let offset = scale.offset_for(angle, target);
        assert_eq!(scale.with_offset(offset.into()).position(angle), target);
    }
}

#[test]
fn a_counter_continues_past_the_revolutions_of_the_sensor() {
    let turn = |turns: i64| Angle::from_fractions(turns << 32 | 1 << 31);
    let scale = Scale::new(SINGLE, 0x2000, 0x8000).counting_on();
    assert_eq!(scale.position(turn(3)), 0x7000);
    assert_eq!(scale.position(turn(-1)), 0x7000);
    let scale = Scale::new(MULTIVO, 0x1000, 0x3000_0000).counting_on();
    assert_eq!(scale.position(turn(0x1_0000)), 0x1000_0800);
    assert_eq!(scale.position(turn(0x3_0000)), 0x800);
    assert_eq!(
        scale.with_code_sequence(true).position(turn(0)),
        0x2FFF_F800
    );
}

#[test]
fn a_gear_is_exact_at_the_ends_of_the_simulation() {
    let scale = Scale::new(MULTIVO, 0x2000, 1_000_003);
    for (numerator, denominator) in [(1, 1), (7, 3), (3, 7), (u64::MAX, 1 << 40), (1, u64::MAX)] {
        let geared = scale.with_gear(numerator, denominator);
        for turns in [0, 1, -1, 12_345, i64::from(i32::MAX), i64::from(i32::MIN)] {
            let steps = i128::from(turns) * 0x2000 + 0x1000;
            let angle = Angle::from_fractions(turns << 32 | 1 << 31);
            // Computed in two halves, so that the product needs no larger integer.
            let (n, d) = (i128::from(numerator), i128::from(denominator));
            let whole = steps.div_euclid(d) * n + steps.rem_euclid(d) * n / d;
            let expected = whole.rem_euclid(1_000_003);
            assert_eq!(i128::from(geared.position(angle)), expected, "{turns}");
        }
    }
    let nothing = scale
        .with_gear(5, 0)
        .position(Angle::from_fractions(1 << 32));
    assert_eq!(nothing, 5 * 0x2000);
}
