//! Positions of the bus-cover family compared with a second calculation in 128 bits: the sensor, the
//! two ranges that wrap, and the revolution counter that misses motion without power.

use crate::bench::{Bench, SAVE};
use crate::reference::{Random, turns};

struct Model {
    /// Steps per revolution and revolutions of the sensor.
    sensor: (i128, i128),
    /// In 2⁻³² revolutions, as counted.
    angle: i128,
    reversed: bool,
    scaling: bool,
    steps: i128,
    range: i128,
    offset: i128,
}

impl Model {
    /// Steps, range, and the position where counting starts again.
    fn scale(&self) -> (i128, i128, i128) {
        let (steps, range) = if self.scaling {
            (self.steps, self.range)
        } else {
            (self.sensor.0, self.sensor.0 * self.sensor.1)
        };
        (steps, range, range.min(steps * self.sensor.1))
    }

    fn without_offset(&self) -> i128 {
        let (steps, range, wrap) = self.scale();
        let angle = match self.sensor.1 {
            1 => self.angle.rem_euclid(1 << 32),
            _ => self.angle,
        };
        let raw = (angle * self.sensor.0).div_euclid(1 << 32);
        let p = (raw * steps).div_euclid(self.sensor.0).rem_euclid(wrap);
        if self.reversed {
            (range - p) % range
        } else {
            p
        }
    }

    fn position(&self) -> u32 {
        let (_, range, _) = self.scale();
        (self.without_offset() + self.offset).rem_euclid(range) as u32
    }
}

#[test]
fn bus_cover_positions() {
    let mut random = Random(0x5DEE_CE66_D1CE_4E5B);
    for name in [
        "gxmm", "gxam", "gcmm", "gcam", "gbmm", "gbam", "gdmm", "gdam",
    ] {
        let mut bench = Bench::new(name);
        let [resolution, total] = [0x6501, 0x6502].map(|index| i128::from(bench.read(index, 0)));
        let mut model = Model {
            sensor: (resolution, total / resolution),
            angle: 0,
            reversed: false,
            scaling: true,
            steps: resolution,
            range: total,
            offset: 0,
        };
        let mut keeps_offset = false;
        for _ in 0..1000 {
            match random.below(8) {
                of @ (0 | 1) => {
                    let most = if of == 0 { resolution } else { total };
                    let value = random.magnitude(32) as i128;
                    let expected = (1..=most).contains(&value);
                    let written = bench.write(0x6001 + of as u16, 0, value as u32);
                    assert_eq!(written.is_ok(), expected, "{name} {value}");
                    if expected {
                        *(if of == 0 {
                            &mut model.steps
                        } else {
                            &mut model.range
                        }) = value;
                        model.offset = if keeps_offset { model.offset } else { 0 };
                    }
                }
                2 => {
                    let bits = random.below(8) as u32;
                    bench.write(0x6000, 0, bits).unwrap();
                    (model.reversed, model.scaling) = (bits & 1 != 0, bits & 4 != 0);
                }
                3 => {
                    let (preset, range) = (random.magnitude(32) as i128, model.scale().1);
                    let written = bench.write(0x6003, 0, preset as u32);
                    assert_eq!(written.is_ok(), preset < range, "{name} {preset}");
                    if preset < range {
                        model.offset = (preset - model.without_offset()).rem_euclid(range);
                        assert_eq!(i128::from(bench.read(0x6509, 0)), model.offset);
                    }
                }
                4 => {
                    keeps_offset = !keeps_offset;
                    let options = if keeps_offset { 0x208 } else { 0x008 };
                    bench.write(0x2110, 0, options).unwrap();
                }
                5 => {
                    bench.write(0x1010, 1, SAVE).unwrap();
                    let by = i128::from(turns(&mut random) >> 32);
                    bench.power_cycle(100, by as i64);
                    // The counter does not see that its zero was crossed.
                    let (laps, on) = (model.sensor.1 << 32, model.angle + (by << 32));
                    let unseen = on.div_euclid(laps) - model.angle.div_euclid(laps);
                    model.angle = on - unseen * laps;
                }
                _ => {
                    let by = turns(&mut random);
                    bench.turn_fractions(by);
                    model.angle += i128::from(by);
                }
            }
            assert_eq!(bench.position(), model.position(), "{name}");
            if model.angle.abs() > 1 << 60 {
                bench.turn_fractions(-model.angle as i64);
                model.angle = 0;
            }
        }
    }
}
