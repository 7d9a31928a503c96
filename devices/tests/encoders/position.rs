//! Ranges, resolutions, offsets: manual 001 chapters 4.4.2 and 12.3, manual 003 chapters 6.9
//! to 6.13.

use crate::bench::{Bench, OUT_OF_RANGE, SAVE, TOO_GREAT, TOO_LITTLE};

/// A sixteenth of a revolution.
const SIXTEENTH: i64 = 1 << 28;

#[test]
fn eam_uses_14_of_16_bits_and_counts_to_the_end_of_32() {
    let mut bench = Bench::new("eam_mt");
    let objects = [0x6001, 0x6002, 0x6501, 0x6502, 0x6509, 0x6500];
    let values = objects.map(|index| bench.read(index, 0));
    assert_eq!(values, [0x4000, 0, 0x4000, 0x4_0000, 0, 4]);
    bench.turn_fractions(SIXTEENTH);
    assert_eq!(bench.position(), 0x400);
    // One step of the sensor is a quarter of a shown step.
    bench.turn_fractions(3 << 16);
    assert_eq!(bench.position(), 0x400);
    bench.turn_fractions(1 << 16);
    assert_eq!(bench.position(), 0x401);
    bench.turn(0x3_FFFF);
    assert_eq!(bench.position(), 0xFFFF_C401);
    bench.turn(1);
    assert_eq!(bench.position(), 0x401);
    bench.turn(-1);
    assert_eq!(bench.position(), 0xFFFF_C401);
    // Scaling off gives the same (MANUALS.md U-34), and the other direction 2^32 minus it.
    bench.write(0x6000, 0, 0).unwrap();
    assert_eq!((bench.position(), bench.read(0x6500, 0)), (0xFFFF_C401, 0));
    bench.write(0x6000, 0, 1).unwrap();
    assert_eq!((bench.position(), bench.read(0x6500, 0)), (0x3BFF, 1));
    bench.write(0x6000, 0, 4).unwrap();
    bench.write(0x6001, 0, 0x1_0000).unwrap();
    bench.turn_fractions(1 << 16);
    assert_eq!(bench.position() & 0xFFFF, 0x1005);
}

#[test]
fn eam_6502h_follows_every_write() {
    let mut bench = Bench::new("eam_mt");
    bench.write(0x6001, 0, 3600).unwrap();
    assert_eq!(
        (bench.read(0x6002, 0), bench.read(0x6502, 0)),
        (0, 1_193_046)
    );
    bench.write(0x6002, 0, 3600 << 12).unwrap();
    assert_eq!((bench.read(0x6001, 0), bench.read(0x6502, 0)), (3600, 4096));
    for (value, expected) in [
        (0, Ok(())),
        (3600, Ok(())),
        (7200, Ok(())),
        (3600 * 3, OUT_OF_RANGE),
        (3601, OUT_OF_RANGE),
        (1800, OUT_OF_RANGE),
        (1, OUT_OF_RANGE),
        (0xFFFF_FFFF, OUT_OF_RANGE),
        (3600 << 20, Ok(())),
    ] {
        assert_eq!(bench.write(0x6002, 0, value), expected, "{value}");
    }
    // 6001h need not divide 6002h (C-EAM-18).
    for (value, expected) in [
        (3, OUT_OF_RANGE),
        (4, Ok(())),
        (0x1_0000, Ok(())),
        (0x1_0001, TOO_GREAT),
        (7, Ok(())),
    ] {
        assert_eq!(bench.write(0x6001, 0, value), expected, "{value}");
    }
    let turns = (3600u32 << 20) / 7;
    assert_eq!(
        (bench.read(0x6002, 0), bench.read(0x6502, 0)),
        (3600 << 20, turns)
    );
    bench.write(0x6001, 0, 0x1_0000).unwrap();
    bench.write(0x6002, 0, 0x8000_0000).unwrap();
    assert_eq!(bench.read(0x6502, 0), 0x8000);
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle(100, 0);
    assert_eq!(bench.read(0x6502, 0), 0x8000);
}

#[test]
fn eam_range_of_four_steps_per_revolution_has_two_to_the_thirty_revolutions() {
    let mut bench = Bench::new("eam_mt");
    bench.write(0x6001, 0, 4).unwrap();
    assert_eq!(bench.read(0x6502, 0), 1 << 30);
    bench.turn((1 << 30) - 1);
    assert_eq!(bench.position(), 0xFFFF_FFFC);
    bench.turn(1);
    assert_eq!(bench.position(), 0);
}

#[test]
fn eam_preset_and_offset_are_each_in_two_objects() {
    let mut bench = Bench::new("eam_mt");
    bench.turn_fractions(SIXTEENTH);
    bench.write(0x6003, 0, 10).unwrap();
    assert_eq!(bench.position(), 10);
    let linked = [(0x6010, 1), (0x6509, 0), (0x650C, 1)];
    let values = linked.map(|(index, sub)| bench.read(index, sub) as i32);
    assert_eq!(values, [10, 10 - 0x400, 10 - 0x400]);
    bench.write(0x6010, 1, 0xFFFF_FFFF).unwrap();
    assert_eq!(
        (bench.position(), bench.read(0x6003, 0)),
        (0xFFFF_FFFF, 0xFFFF_FFFF)
    );
    // C-EAM-28: one saved value.
    bench.write(0x6003, 0, 5).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle(100, 1);
    assert_eq!((bench.position(), bench.read(0x6010, 1)), (5 + 0x4000, 5));
    assert_eq!(bench.read(0x650C, 1) as i32, 5 - 0x400);
    assert_eq!(bench.read(0x6509, 0) as i32, 5 - 0x400);
    bench.write(0x6002, 0, 0x4000).unwrap();
    assert_eq!(
        (bench.read(0x6509, 0), bench.read(0x650C, 1)),
        (0, 0),
        "U-11"
    );
    assert_eq!(bench.write(0x6003, 0, 0x4000), TOO_GREAT);
    assert_eq!(bench.write(0x6010, 1, 0x4000), TOO_GREAT);
    assert_eq!(bench.write(0x6010, 1, 0x3FFF), Ok(()));
    assert_eq!(bench.position(), 0x3FFF);
}

#[test]
fn eam_offset_is_right_in_a_range_that_is_not_a_power_of_two() {
    let mut bench = Bench::new("eam_mt");
    bench.write(0x6001, 0, 0xC000).unwrap();
    bench.write(0x6002, 0, 0xC000_0000).unwrap();
    bench.turn_fractions(SIXTEENTH);
    bench.write(0x6003, 0, 0xBFFF_FFFF).unwrap();
    assert_eq!(bench.position(), 0xBFFF_FFFF);
    assert_eq!(bench.read(0x6509, 0) as i32, -1 - 0xC00);
    bench.turn(-1);
    assert_eq!(bench.position(), 0xBFFF_3FFF);
    bench.turn(0x1_0000);
    assert_eq!(bench.position(), 0xBFFF_3FFF);
}

#[test]
fn eam_singleturn_counts_revolutions_while_it_has_power() {
    let mut bench = Bench::new("eam_st");
    assert_eq!((bench.read(0x6002, 0), bench.read(0x6502, 0)), (0x4000, 1));
    bench.turn(5);
    bench.turn_fractions(SIXTEENTH);
    assert_eq!(bench.position(), 0x400);
    bench.write(0x6002, 0, 0x2_0000).unwrap();
    assert_eq!((bench.position(), bench.read(0x6502, 0)), (0x1_4400, 8));
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle(100, 1);
    assert_eq!(bench.position(), 0x400);
    bench.turn(-1);
    assert_eq!(bench.position(), 0x1_C400);
    bench.write(0x6000, 0, 0).unwrap();
    assert_eq!(bench.position(), 0x400, "one revolution with scaling off");
}

#[test]
fn eam_an_injected_offset_ends_with_a_restart() {
    let mut bench = Bench::new("eam_mt");
    bench.write(0x6002, 0, 0x10_0000).unwrap();
    bench.turn_fractions(SIXTEENTH);
    bench.write(0x2116, 2, 0x10_0003).unwrap();
    assert_eq!((bench.position(), bench.read(0x6509, 0)), (0x403, 0));
    bench.write(0x6003, 0, 0).unwrap();
    assert_eq!(bench.position(), 3, "the preset does not know of it");
    bench.write(0x2116, 2, 0xFFFF_FFFF).unwrap();
    assert_eq!(bench.position(), 0xF_FFFF);
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.nmt(0x81);
    assert_eq!((bench.position(), bench.read(0x2116, 2)), (0, 0));
}

#[test]
fn en_accepts_21_bits_and_65536_revolutions() {
    let mut bench = Bench::new("en580c");
    let objects = [0x6001, 0x6002, 0x6501, 0x6502];
    let values = objects.map(|index| bench.read(index, 0));
    assert_eq!(values, [0x2000, 0x2000_0000, 0x100_0000, 0x1_0000]);
    for (index, value, expected) in [
        (0x6001, 0, TOO_LITTLE),
        (0x6001, 0x20_0001, TOO_GREAT),
        (0x6001, 0x20_0000, Ok(())),
        (0x6002, 1, TOO_LITTLE),
        (0x6002, 2, Ok(())),
        (0x6002, 0x8000_0001, TOO_GREAT),
        (0x6002, 0x8000_0000, Ok(())),
        (0x6001, 0x2000, Ok(())),
        // 65,536 revolutions are the maximum; writing 6001h first always works.
        (0x6002, 0x2000_0001, TOO_GREAT),
        (0x6002, 0x2000_0000, Ok(())),
        (0x6001, 5000, Ok(())),
        (0x6002, 15_000, Ok(())),
        (0x6001, 1, Ok(())),
        (0x6002, 0x1_0000, Ok(())),
        (0x6002, 0x1_0001, TOO_GREAT),
        (0x6003, 0xFFFF, Ok(())),
        (0x6003, 0x1_0000, TOO_GREAT),
    ] {
        assert_eq!(
            bench.write(index, 0, value),
            expected,
            "{index:X} {value:X}"
        );
    }
    assert_eq!(bench.read(0x6502, 0), 0x1_0000);
}

#[test]
fn en_raw_is_the_sensor_modulo_32_bits() {
    let mut bench = Bench::new("en580c");
    bench.turn(0x801);
    bench.turn_fractions(SIXTEENTH);
    let raw = (0x801u64 * 0x20_0000 + 0x2_0000) as u32;
    assert_eq!(bench.read(0x600C, 0), raw);
    assert_eq!(bench.position(), 0x801 * 0x2000 + 0x200);
    bench.write(0x6003, 0, 7).unwrap();
    assert_eq!((bench.position(), bench.read(0x600C, 0)), (7, raw));
    bench.write(0x6002, 0, 0x2000).unwrap();
    bench.write(0x6000, 0, 1).unwrap();
    assert_eq!(bench.position(), raw.wrapping_neg());
    assert_eq!(bench.read(0x600C, 0), raw);
    bench.write(0x6000, 0, 0).unwrap();
    assert_eq!(bench.position(), raw);
    // U-13: the written values can be read.
    assert_eq!(
        (bench.read(0x6001, 0), bench.read(0x6002, 0)),
        (0x2000, 0x2000)
    );
}

#[test]
fn en_endless_mode_continues_past_the_counter_and_without_power() {
    let mut bench = Bench::new("en580c");
    bench.write(0x6001, 0, 5000).unwrap();
    bench.write(0x6002, 0, 15_000).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.turn(65_534);
    bench.turn_fractions(SIXTEENTH);
    let step = 312; // 5000 / 16
    assert_eq!(bench.position(), 65_534 % 3 * 5000 + step);
    bench.turn(3);
    assert_eq!(
        bench.position(),
        65_537 % 3 * 5000 + step,
        "past the counter's end"
    );
    for (off, total) in [(32_768, 98_305), (-32_768, 65_537), (32_767, 98_304)] {
        bench.power_cycle(100, off);
        assert_eq!(bench.position(), total % 3 * 5000 + step, "{off}");
    }
    // One revolution too many: 65,536 revolutions are lost, which is not a multiple of 3.
    bench.power_cycle(100, 32_769);
    let wrong = (98_304 + 32_769 - 65_536) % 3 * 5000 + step;
    assert_eq!(bench.position(), wrong);
    bench.write(0x6003, 0, 0).unwrap();
    bench.turn(2);
    assert_eq!(bench.position(), 10_000, "a preset makes it good again");
}

#[test]
fn en_a_power_of_two_is_right_after_any_motion_without_power() {
    let mut bench = Bench::new("en580c");
    bench.write(0x6001, 0, 5000).unwrap();
    bench.write(0x6002, 0, 20_000).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle(100, 1_000_001);
    assert_eq!(bench.position(), 5000);
    bench.power_cycle(100, -3_000_002);
    assert_eq!(bench.position(), 15_000);
}
