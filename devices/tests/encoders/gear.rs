//! The electronic gear of both manuals: manual 001, chapter 4.4.6; manual 003, chapter 6.6.

use crate::bench::{Bench, INCOMPATIBLE, OUT_OF_RANGE, SAVE, TOO_GREAT, TOO_LITTLE};

#[test]
fn the_eam_gear_takes_effect_after_save_and_restart() {
    let mut bench = Bench::new("eam_mt");
    bench.turn(25);
    assert_eq!(bench.position(), 409_600);
    for (sub, value, expected) in [
        (1, 0, OUT_OF_RANGE),
        (1, 3, OUT_OF_RANGE),
        (2, 0, OUT_OF_RANGE),
        (2, 32_768, TOO_GREAT),
        (3, 0, OUT_OF_RANGE),
        (3, 32_768, TOO_GREAT),
        (2, 32_767, Ok(())),
        // i = 6.25, the gear box in the manual.
        (2, 625, Ok(())),
        (3, 100, Ok(())),
        (1, 2, Ok(())),
    ] {
        assert_eq!(bench.write(0x2001, sub, value), expected, "{sub} {value}");
    }
    assert_eq!(bench.position(), 409_600);
    bench.write(0x1010, 4, SAVE).unwrap();
    assert_eq!(bench.position(), 409_600);
    bench.nmt(0x82);
    assert_eq!(
        bench.position(),
        409_600,
        "a reset communication is not one"
    );
    bench.nmt(0x81);
    assert_eq!(bench.position(), 65_536);
    // Switching off also takes effect with the next start.
    bench.write(0x2001, 1, 1).unwrap();
    assert_eq!(bench.position(), 65_536);
    bench.power_cycle(100, 0);
    assert_eq!(bench.position(), 65_536, "it was not saved");
    bench.write(0x2001, 1, 1).unwrap();
    bench.write(0x1010, 4, SAVE).unwrap();
    bench.power_cycle(100, 0);
    assert_eq!(bench.position(), 409_600);
}

#[test]
fn the_eam_gear_is_exact_over_many_revolutions_and_without_power() {
    let mut bench = Bench::new("eam_mt");
    for (sub, value) in [(2, 17), (3, 8), (1, 2)] {
        bench.write(0x2001, sub, value).unwrap();
    }
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle(100, 0);
    let mut turns = 0u64;
    for by in [17, 17 * 100_000, 17 * 10_000_000, 3] {
        bench.turn(by);
        turns += by as u64;
        let expected = turns * 0x4000 * 8 / 17;
        assert_eq!(bench.position(), expected as u32, "{turns}");
    }
    bench.power_cycle(100, (1 << 29) - 1);
    turns += (1 << 29) - 1;
    assert_eq!(bench.position(), (turns * 0x4000 * 8 / 17) as u32);
    bench.write(0x6003, 0, 1000).unwrap();
    bench.turn(17);
    assert_eq!(bench.position(), 1000 + 8 * 0x4000);
    bench.turn(-34);
    assert_eq!(bench.position(), 1000u32.wrapping_sub(8 * 0x4000));
}

#[test]
fn the_redundant_eam_has_no_gear() {
    let mut bench = Bench::new("eam_red");
    assert_eq!(bench.write(0x2001, 1, 2), Err(0x0602_0000));
}

#[test]
fn en_6002h_is_one_revolution_of_the_output() {
    let mut bench = Bench::new("en580c");
    assert_eq!(bench.read(0x2001, 1), 0, "MANUALS.md C-EN-04");
    for (sub, value, expected) in [
        (1, 2, OUT_OF_RANGE),
        (2, 0, TOO_LITTLE),
        (3, 0, TOO_LITTLE),
        // 6001h would be 20000000h.
        (1, 1, INCOMPATIBLE),
        (2, 75, Ok(())),
        (3, 10, Ok(())),
    ] {
        assert_eq!(bench.write(0x2001, sub, value), expected, "{sub} {value}");
    }
    bench.write(0x6002, 0, 10_000).unwrap();
    bench.write(0x6003, 0, 77).unwrap();
    bench.write(0x2001, 2, 75).unwrap();
    assert_eq!(bench.position(), 77, "off, its numbers mean nothing");
    bench.write(0x2001, 1, 1).unwrap();
    assert_eq!((bench.read(0x6001, 0), bench.read(0x6509, 0)), (1333, 0));
    bench.turn(7);
    assert_eq!(bench.position(), 9333);
    bench.turn_fractions(1 << 31);
    assert_eq!(bench.position(), 0, "one revolution of the output");
    bench.turn(15 * 1_000_000 + 3);
    assert_eq!(bench.position(), 4000);
    bench.power_cycle(100, 0);
    assert_eq!(bench.read(0x6001, 0), 0x2000, "nothing was saved");
}

#[test]
fn en_6001h_is_computed_and_has_its_limit() {
    let mut bench = Bench::new("en580c");
    bench.write(0x6002, 0, 10_000).unwrap();
    for (sub, value) in [(2, 75), (3, 10), (1, 1)] {
        bench.write(0x2001, sub, value).unwrap();
    }
    bench.turn(1);
    bench.write(0x6003, 0, 5).unwrap();
    bench.write(0x6001, 0, 4096).unwrap();
    assert_eq!(
        (bench.read(0x6001, 0), bench.position()),
        (1333, 5),
        "without effect"
    );
    // The maximum is 200000h steps per revolution: 2^21 × 7.5.
    assert_eq!(bench.write(0x6002, 0, 15_728_641), INCOMPATIBLE);
    bench.write(0x6002, 0, 15_728_640).unwrap();
    assert_eq!(bench.read(0x6001, 0), 0x20_0000);
    assert_eq!(bench.write(0x2001, 3, 11), INCOMPATIBLE);
    assert_eq!(bench.write(0x2001, 2, 74), INCOMPATIBLE);
    assert_eq!(bench.write(0x2001, 2, 0), TOO_LITTLE);
    assert_eq!(bench.write(0x2001, 3, 0), TOO_LITTLE);
    bench.write(0x2001, 2, 150).unwrap();
    assert_eq!(bench.read(0x6001, 0), 0x10_0000);
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle(100, 0);
    assert_eq!(bench.read(0x6001, 0), 0x10_0000);
    bench.write(0x2001, 1, 0).unwrap();
    bench.write(0x6001, 0, 4096).unwrap();
    assert_eq!(bench.read(0x6001, 0), 4096);
}
