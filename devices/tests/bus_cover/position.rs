//! The position of each device at the ends of its range (manual 000, objects 6000h to 6004h,
//! 6501h, 6502h, 6509h), in frames.

use odkit::Frame;
use odkit::encoder::{Angle, Fault};

use crate::bench::Bench;
use crate::models::{MODELS, Model};

const SAVE: u32 = u32::from_le_bytes(*b"save");
/// MANUALS.md U-05: above a limit, and below one.
const TOO_GREAT: Result<(), u32> = Err(0x0609_0031);
const OUT_OF_RANGE: Result<(), u32> = Err(0x0609_0030);

impl Bench {
    fn put(&mut self, raw: u32) {
        self.set_raw(raw.into());
    }

    /// Turns the shaft by this number of sensor steps, also past the ends of the range.
    fn turn(&mut self, model: &Model, steps: i64) {
        let step = (1 << 32) / i64::from(model.resolution);
        let by = Angle::from_fractions(steps * step);
        self.node.application.shaft.turn(self.now, by);
    }

    fn position(&mut self) -> u32 {
        self.read(0x6004, 0)
    }
}

/// A device, and its name for messages of failures.
fn all() -> impl Iterator<Item = (&'static Model, Bench)> {
    MODELS.iter().map(|model| (model, Bench::new(&model.id())))
}

#[test]
fn after_the_last_step_comes_the_first() {
    for (model, mut bench) in all() {
        let last = model.range - 1;
        bench.put(last);
        assert_eq!(bench.position(), last, "{}", model.name);
        bench.turn(model, 1);
        assert_eq!(bench.position(), 0, "{}", model.name);
        bench.turn(model, -1);
        assert_eq!(bench.position(), last, "{}", model.name);
        bench.turn(model, i64::from(model.range));
        assert_eq!(bench.position(), last, "{}", model.name);
        // One revolution less than all: a singleturn does not count revolutions.
        bench.turn(model, -i64::from(model.resolution));
        let expected = if model.is_multiturn() {
            last - model.resolution
        } else {
            last
        };
        assert_eq!(bench.position(), expected, "{}", model.name);
    }
}

#[test]
fn the_pdo_contains_all_bits() {
    for (model, mut bench) in all() {
        bench.put(model.range - 1);
        assert_eq!(bench.send(0x000, &[1, 1]), []);
        bench.now = bench.now.plus_millis(0x203);
        bench.node.handle_timeout(bench.now);
        let data = (model.range - 1).to_le_bytes();
        let pdo = Frame::standard(0x181, &data);
        assert_eq!(bench.sent(), [pdo], "{}", model.name);
    }
}

#[test]
fn resolution_and_range_have_their_limits() {
    for (model, mut bench) in all() {
        bench.put(model.range - 1);
        for (index, most) in [(0x6001, model.resolution), (0x6002, model.range)] {
            for refused in [most + 1, 0x8000_0001, u32::MAX] {
                assert_eq!(bench.write(index, 0, refused), TOO_GREAT, "{}", model.name);
            }
            assert_eq!(bench.write(index, 0, 0), OUT_OF_RANGE, "{}", model.name);
            assert_eq!(bench.read(index, 0), most, "nothing was written");
            for accepted in [1, most - 1, most] {
                assert_eq!(bench.write(index, 0, accepted), Ok(()), "{}", model.name);
                assert_eq!(bench.read(index, 0), accepted);
            }
        }
        assert_eq!(bench.position(), model.range - 1);
        // The objects of the sensor do not follow.
        bench.write(0x6001, 0, 1).unwrap();
        let sensor = (bench.read(0x6501, 0), bench.read(0x6502, 0));
        assert_eq!(sensor, (model.resolution, model.range));
        // One step per revolution: the range has more revolutions than the sensor (U-12).
        assert_eq!(bench.position(), model.turns - 1, "{}", model.name);
        bench.turn(model, 1);
        assert_eq!(bench.position(), 0, "{}", model.name);
    }
}

/// Offsets and positions, compared with a calculation in 128 bits.
#[test]
fn a_preset_works_at_any_position() {
    for (model, mut bench) in all() {
        for range in [model.range, model.range - 1, model.range / 2 + 1, 1000, 1] {
            bench.write(0x6002, 0, range).unwrap();
            for raw in [0, 1, model.range / 2, model.range - 1] {
                for preset in [0, range / 2, range - 1] {
                    let what = format!("{}: {preset} of {range} at {raw}", model.name);
                    bench.put(raw);
                    bench.write(0x6003, 0, preset).unwrap();
                    assert_eq!(bench.position(), preset, "{what}");
                    let shown = i128::from(raw) % i128::from(range);
                    let offset = (i128::from(preset) - shown).rem_euclid(range.into());
                    assert_eq!(i128::from(bench.read(0x6509, 0)), offset, "{what}");
                    bench.turn(model, 1);
                    // A multiturn continues to count, a singleturn starts again.
                    let raw = match raw + 1 {
                        past if past == model.resolution && !model.is_multiturn() => 0,
                        next => i128::from(next),
                    };
                    let next = (raw % i128::from(range) + offset) % i128::from(range);
                    assert_eq!(i128::from(bench.position()), next, "{what}, a step on");
                }
                // Refused downloads change nothing.
                let before = [0x6003, 0x6004, 0x6509].map(|index| bench.read(index, 0));
                for refused in [range, u32::MAX] {
                    assert_eq!(bench.write(0x6003, 0, refused), TOO_GREAT, "{}", model.name);
                }
                let after = [0x6003, 0x6004, 0x6509].map(|index| bench.read(index, 0));
                assert_eq!(before, after, "{}", model.name);
            }
        }
    }
}

#[test]
fn counter_clockwise_it_counts_down_from_the_range() {
    for (model, mut bench) in all() {
        let last = model.range - 1;
        bench.write(0x6000, 0, 5).unwrap();
        assert_eq!(bench.read(0x6500, 0), 5);
        for (raw, expected) in [(0, 0), (1, last), (last, 1)] {
            bench.put(raw);
            assert_eq!(bench.position(), expected, "{} at {raw}", model.name);
        }
        bench.write(0x6003, 0, last).unwrap();
        assert_eq!(bench.position(), last, "{}", model.name);
        bench.turn(model, -1);
        assert_eq!(bench.position(), 0, "{}", model.name);
    }
}

#[test]
fn a_range_that_is_not_a_power_of_two() {
    for (model, mut bench) in all() {
        let (resolution, range) = (model.resolution / 4 * 3, model.range / 4 * 3);
        bench.write(0x6001, 0, resolution).unwrap();
        bench.write(0x6002, 0, range).unwrap();
        for (raw, expected) in [
            (model.range - 1, range - 1),
            (model.range / 2, range / 2),
            (model.range / 2 - 1, range / 2 - 1),
            (0, 0),
        ] {
            bench.put(raw);
            assert_eq!(bench.position(), expected, "{} at {raw}", model.name);
        }
        bench.turn(model, -1);
        assert_eq!(bench.position(), range - 1, "{}", model.name);
        // Without scaling it is the raw position of the sensor.
        bench.write(0x6000, 0, 0).unwrap();
        assert_eq!(bench.position(), model.range - 1, "{}", model.name);
        bench.write(0x6000, 0, 4).unwrap();
        assert_eq!(bench.position(), range - 1, "{}", model.name);
    }
}

#[test]
fn the_last_position_survives_a_power_cycle() {
    for (model, mut bench) in all() {
        bench.put(model.range / 3);
        bench.write(0x6003, 0, model.range - 1).unwrap();
        bench.write(0x1010, 1, SAVE).unwrap();
        bench.power_cycle();
        assert_eq!(bench.booted, 1);
        assert_eq!(bench.read(0x6002, 0), model.range, "{}", model.name);
        assert_eq!(bench.position(), model.range - 1, "{}", model.name);
        bench.turn(model, 1);
        bench.power_cycle();
        assert_eq!(bench.position(), 0, "{}", model.name);
    }
}

#[test]
fn sdo_and_lss_name_the_same_product() {
    for (model, mut bench) in all() {
        assert_eq!(bench.read(0x1000, 0), model.device_type);
        assert_eq!(bench.read(0x1008, 0).to_le_bytes(), model.name.as_bytes());
        assert_eq!(bench.read(0x1018, 2), model.product_code);
        // In Stopped: switch state global, inquire product code (chapter 4.3.7).
        assert_eq!(bench.send(0x000, &[2, 1]), []);
        bench.send(0x7E5, &[0x04, 1, 0, 0, 0, 0, 0, 0]);
        let answer = bench.send(0x7E5, &[0x5B, 0, 0, 0, 0, 0, 0, 0]);
        let [a, b, c, d] = model.product_code.to_le_bytes();
        let expected = Frame::standard(0x7E4, &[0x5B, a, b, c, d, 0, 0, 0]);
        assert_eq!(answer, [expected], "{}", model.name);
    }
}

/// 6505h and 6506h: a singleturn has no battery.
#[test]
fn only_a_multiturn_has_a_battery() {
    for (model, mut bench) in all() {
        bench.node.application.set_fault(Fault::Battery, true);
        bench.node.handle_change(bench.now);
        let emcy = Frame::standard(0x81, &[0x00, 0xFF, 0x81, 0, 0, 0x10, 0, 0]);
        let (sent, warnings) = if model.is_multiturn() {
            (vec![emcy], 0x10)
        } else {
            (vec![], 0)
        };
        assert_eq!(bench.sent(), sent, "{}", model.name);
        assert_eq!(bench.read(0x6505, 0), warnings, "{}", model.name);
    }
}
