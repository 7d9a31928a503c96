//! Speed and acceleration: manual 001 chapters 4.4.4 and 4.4.5, manual 003 chapters 6.2 to 6.5.

use crate::bench::{Bench, OUT_OF_RANGE, TOO_GREAT, TOO_LITTLE};

#[test]
fn eam_speed_in_steps_and_in_revolutions() {
    let mut bench = Bench::new("eam_mt");
    let speeds = |bench: &mut Bench| (bench.read(0x6030, 1) as i32, bench.read16(0x2118, 0));
    assert_eq!(bench.read(0x4001, 0), 50);
    bench.rpm(60_000);
    bench.wait(49);
    assert_eq!(
        speeds(&mut bench),
        (0, 0),
        "not known before a whole interval"
    );
    bench.wait(1);
    assert_eq!(speeds(&mut bench), (0x4000, 60));
    bench.write(0x6001, 0, 1000).unwrap();
    assert_eq!(speeds(&mut bench), (1000, 60));
    bench.write(0x6000, 0, 5).unwrap();
    assert_eq!(speeds(&mut bench), (-1000, -60));
    // 2110h bit 0: the speed ignores bit 0 of 6000h.
    bench.write(0x2110, 0, 9).unwrap();
    assert_eq!(speeds(&mut bench), (1000, 60));
    bench.write(0x6000, 0, 1).unwrap();
    assert_eq!(speeds(&mut bench), (0x4000, 60), "scaling off");
    // Half of the interval, at twice the speed.
    bench.rpm(120_000);
    bench.wait(25);
    assert_eq!(speeds(&mut bench), (0x6000, 90));
    bench.wait(25);
    assert_eq!(speeds(&mut bench), (0x8000, 120));
    bench.rpm(-1);
    bench.wait(50);
    // 16384 / 60000 of a step per second, rounded towards 0.
    assert_eq!(speeds(&mut bench), (0, 0));
    bench.rpm(-1_999_999);
    bench.wait(50);
    assert_eq!(speeds(&mut bench), (-546_133, -1999));
}

#[test]
fn eam_speed_is_limited_at_both_ends() {
    let mut bench = Bench::new("eam_mt");
    bench.write(0x6001, 0, 0x1_0000).unwrap();
    for (milli_rpm, steps, revolutions) in [
        (32_767_000, 32_767 * 0x1_0000 / 60, 32_767),
        (32_768_000, (32_768i64 * 0x1_0000 / 60) as i32, 32_767),
        (-32_768_000, -((32_768i64 * 0x1_0000 / 60) as i32), -32_768),
        (-32_769_000, -((32_769i64 * 0x1_0000 / 60) as i32), -32_768),
        (1_966_079_000, 2_147_482_555, 32_767),
        (1_966_080_000, i32::MAX, 32_767),
        (i32::MAX, i32::MAX, 32_767),
        (-1_966_080_000, i32::MIN, -32_768),
        (i32::MIN, i32::MIN, -32_768),
    ] {
        bench.rpm(milli_rpm);
        bench.wait(50);
        assert_eq!(bench.read(0x6030, 1) as i32, steps, "{milli_rpm}");
        assert_eq!(bench.read16(0x2118, 0), revolutions, "{milli_rpm}");
    }
}

#[test]
fn eam_speed_starts_again_after_a_change_of_the_interval() {
    let mut bench = Bench::new("eam_mt");
    for (value, expected) in [
        (0, OUT_OF_RANGE),
        (501, TOO_GREAT),
        (1, Ok(())),
        (500, Ok(())),
    ] {
        assert_eq!(bench.write(0x4001, 0, value), expected, "{value}");
    }
    bench.rpm(6_000);
    bench.wait(499);
    assert_eq!(bench.read16(0x2118, 0), 0);
    bench.wait(1);
    assert_eq!(bench.read16(0x2118, 0), 6);
    bench.power_cycle(100, 0);
    bench.wait(49);
    assert_eq!(
        bench.read16(0x2118, 0),
        0,
        "the default, 50 ms, since the start"
    );
    bench.wait(1);
    assert_eq!(bench.read16(0x2118, 0), 6);
}

#[test]
fn a_change_of_the_position_value_is_not_a_speed() {
    for (name, speed) in [("eam_mt", 0x4000), ("en580c", 0x2000)] {
        let mut bench = Bench::new(name);
        bench.rpm(60_000);
        bench.wait(500);
        bench.write(0x6003, 0, 1).unwrap();
        assert_eq!(bench.read16(0x6030, 1), speed, "{name}");
        bench.turn(1000);
        bench.turn_fractions(123_456_789);
        bench.wait(10);
        assert_eq!(bench.read16(0x6030, 1), speed, "{name}");
        assert_eq!(bench.read16(0x6040, 1), 0, "{name}");
    }
}

/// 6000 revolutions per minute in one second are 100 revolutions per second squared, 100 × 2^16
/// steps of 16 bits.
#[test]
fn eam_the_example_of_the_manual() {
    let mut bench = Bench::new("eam_mt");
    let parameters = [1, 2, 3, 4].map(|sub| bench.read(0x6041, sub));
    assert_eq!(parameters, [2, 200, 1, 1092]);
    bench.change(|encoder, now| encoder.shaft.ramp_to(now, 6_000_000, 1_000_000));
    for _ in 0..8 {
        bench.wait(100);
        let expected = match bench.now.as_micros() {
            100_000 => 0,
            // 6553600 / 1092.
            _ => 6001,
        };
        assert_eq!(bench.read16(0x6040, 1), expected);
    }
    // 0.8 s: the speed is the mean of the last 50 ms.
    assert_eq!(bench.read16(0x2118, 0), 4650);
    bench.wait(200);
    assert_eq!(bench.read16(0x6040, 1), 6001);
    bench.wait(100);
    assert_eq!(
        bench.read16(0x6040, 1),
        3000,
        "half of the interval is even"
    );
    bench.wait(100);
    assert_eq!(
        (bench.read16(0x6040, 1), bench.read16(0x2118, 0)),
        (0, 6000)
    );
    // Half a revolution per second more each second for a second, after 1000 revolutions.
    assert_eq!(
        bench.node.application.shaft.at(bench.now).fractions(),
        70i64 << 32
    );
    bench.change(|encoder, now| encoder.shaft.ramp_to(now, 0, 500_000));
    bench.wait(400);
    assert_eq!(bench.read16(0x6040, 1), -12_002);
    bench.write(0x6000, 0, 5).unwrap();
    assert_eq!(bench.read16(0x6040, 1), 12_002);
    bench.write(0x2110, 0, 9).unwrap();
    assert_eq!(bench.read16(0x6040, 1), -12_002);
    bench.write(0x6041, 4, 1).unwrap();
    assert_eq!(bench.read16(0x6040, 1), i16::MIN);
    bench.write(0x6000, 0, 4).unwrap();
    bench.write(0x6041, 4, 0xFFFF).unwrap();
    bench.write(0x6041, 3, 0xFFFF).unwrap();
    assert_eq!(bench.read16(0x6040, 1), i16::MIN);
    bench.write(0x6041, 3, 0).unwrap();
    assert_eq!(bench.read16(0x6040, 1), 0);
}

#[test]
fn eam_acceleration_of_the_scaled_position() {
    let mut bench = Bench::new("eam_mt");
    for (sub, value, expected) in [
        (1, 0, OUT_OF_RANGE),
        (1, 3, OUT_OF_RANGE),
        (2, 0, OUT_OF_RANGE),
        (2, 501, TOO_GREAT),
        (4, 0, OUT_OF_RANGE),
        (1, 1, Ok(())),
        (2, 500, Ok(())),
        (3, 3, Ok(())),
        (4, 2, Ok(())),
    ] {
        assert_eq!(bench.write(0x6041, sub, value), expected, "{sub} {value}");
    }
    bench.write(0x6001, 0, 1000).unwrap();
    bench.wait(500);
    // Steps of the speed, 60 revolutions per minute each 100 ms: 10 revolutions per second squared.
    for step in 1..=8 {
        bench.rpm(step * 60_000);
        if step >= 5 {
            assert_eq!(bench.read16(0x6040, 1), 15_000, "{step}");
        }
        bench.wait(100);
    }
    bench.wait(500);
    assert_eq!(bench.read16(0x6040, 1), 0);
}

#[test]
fn en_speed_has_a_source_a_factor_and_16_bits() {
    let mut bench = Bench::new("en580c");
    let parameters = [1, 2, 3, 4].map(|sub| bench.read(0x6031, sub));
    assert_eq!(parameters, [1, 100, 1, 1]);
    for (sub, value, expected) in [
        (1, 0, OUT_OF_RANGE),
        (1, 3, OUT_OF_RANGE),
        (4, 0, TOO_LITTLE),
    ] {
        assert_eq!(bench.write(0x6031, sub, value), expected, "{sub} {value}");
    }
    bench.rpm(60_000);
    bench.wait(99);
    assert_eq!(bench.read16(0x6030, 1), 0);
    bench.wait(1);
    assert_eq!(bench.read16(0x6030, 1), 0x2000);
    bench.write(0x6000, 0, 5).unwrap();
    assert_eq!(bench.read16(0x6030, 1), -0x2000);
    bench.write(0x6031, 3, 3).unwrap();
    bench.write(0x6031, 4, 2).unwrap();
    assert_eq!(bench.read16(0x6030, 1), -0x3000);
    bench.write(0x6031, 4, 1).unwrap();
    bench.write(0x6031, 3, 4).unwrap();
    assert_eq!(bench.read16(0x6030, 1), i16::MIN);
    bench.rpm(-60_000);
    bench.wait(100);
    assert_eq!(bench.read16(0x6030, 1), i16::MAX);
    // 2^21 raw steps per second, and 6000h has no effect on them.
    bench.write(0x6031, 1, 2).unwrap();
    bench.write(0x6031, 4, 1024).unwrap();
    bench.write(0x6031, 3, 1).unwrap();
    bench.wait(99);
    assert_eq!(bench.read16(0x6030, 1), 0, "another source starts again");
    bench.wait(1);
    assert_eq!(bench.read16(0x6030, 1), -2048);
    // With the gear a revolution of the encoder is 1333 1/3 steps.
    bench.write(0x6000, 0, 4).unwrap();
    bench.write(0x6002, 0, 10_000).unwrap();
    for (sub, value) in [(2, 75), (3, 10), (1, 1)] {
        bench.write(0x2001, sub, value).unwrap();
    }
    bench.write(0x6031, 1, 1).unwrap();
    bench.write(0x6031, 4, 1).unwrap();
    bench.rpm(180_000);
    bench.wait(100);
    assert_eq!(bench.read16(0x6030, 1), 4000);
    // There are no limits (MANUALS.md C-EN-24): a minute is accepted.
    bench.write(0x6031, 2, 60_000).unwrap();
    bench.wait(30_000);
    bench.rpm(0);
    bench.wait(30_000);
    assert_eq!(bench.read16(0x6030, 1), 2000);
}

#[test]
fn en_acceleration() {
    let mut bench = Bench::new("en580c");
    let parameters = [1, 2, 3, 4].map(|sub| bench.read(0x6041, sub));
    assert_eq!(parameters, [1, 100, 1, 1]);
    assert_eq!(bench.write(0x6041, 4, 0), TOO_LITTLE);
    bench.write(0x6001, 0, 0x1_0000).unwrap();
    bench.write(0x6041, 4, 1092).unwrap();
    bench.change(|encoder, now| encoder.shaft.ramp_to(now, 6_000_000, 1_000_000));
    bench.wait(500);
    assert_eq!(bench.read16(0x6040, 1), 6001, "100 × 2^16 / 1092");
    bench.write(0x6041, 4, 1).unwrap();
    assert_eq!(bench.read16(0x6040, 1), i16::MAX);
    bench.write(0x6041, 1, 2).unwrap();
    bench.write(0x6041, 4, 0x8000).unwrap();
    bench.write(0x6000, 0, 5).unwrap();
    bench.wait(200);
    assert_eq!(
        bench.read16(0x6040, 1),
        6400,
        "100 × 2^21 / 2^15, whatever 6000h says"
    );
}
