//! Positions and speeds compared with a second, independent calculation in 128 bits: it keeps
//! the whole path of the shaft and divides once.

use odkit::encoder::Angle;

use crate::bench::{Bench, SAVE};

/// xorshift: the same numbers in each run.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    /// All magnitudes are equally likely.
    pub(crate) fn magnitude(&mut self, bits: u64) -> u64 {
        self.next() >> (64 - 1 - self.below(bits))
    }
}

/// Values that a master wrote, and the position of the shaft.
struct Model {
    is_eam: bool,
    /// In 2⁻³² revolutions.
    angle: i128,
    reversed: bool,
    scaling: bool,
    steps: i128,
    range: i128,
    /// Numerator and denominator in effect.
    gear: Option<(i128, i128)>,
    offset: i128,
    injected: i128,
}

impl Model {
    fn range_now(&self) -> i128 {
        if self.scaling { self.range } else { 1 << 32 }
    }

    fn without_offset(&self) -> i128 {
        let raw_steps: i128 = if self.is_eam { 1 << 16 } else { 1 << 21 };
        let raw = (self.angle * raw_steps).div_euclid(1 << 32);
        let steps = match (self.scaling, self.is_eam) {
            (true, _) => self.steps,
            (false, true) => 1 << 14,
            (false, false) => raw_steps,
        };
        let counted = match self.gear {
            Some((numerator, denominator)) if self.is_eam => {
                let encoder = (raw * steps).div_euclid(raw_steps);
                (encoder * denominator).div_euclid(numerator)
            }
            Some((numerator, denominator)) if self.scaling => {
                (raw * self.range * denominator).div_euclid(raw_steps * numerator)
            }
            _ => (raw * steps).div_euclid(raw_steps),
        };
        let p = counted.rem_euclid(self.range_now());
        if self.reversed {
            (self.range_now() - p) % self.range_now()
        } else {
            p
        }
    }

    fn position(&self) -> u32 {
        let p = self.without_offset() + self.offset + self.injected;
        p.rem_euclid(self.range_now()) as u32
    }
}

impl Bench {
    fn put(&mut self, model: &mut Model, by: i64) {
        let before = self.node.application.shaft.seen(self.now);
        self.turn_fractions(by);
        assert_eq!(
            self.node.application.shaft.seen(self.now),
            before.plus(Angle::from_fractions(by))
        );
        model.angle += i128::from(by);
    }
}

/// A motion in either direction, in 2⁻³² revolutions.
pub(crate) fn turns(random: &mut Random) -> i64 {
    let by = random.magnitude(55) as i64;
    if random.next() & 1 == 0 { by } else { -by }
}

#[test]
fn eam_positions() {
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    for round in 0..40 {
        let mut bench = Bench::new(if round % 2 == 0 { "eam_mt" } else { "eam_red" });
        let mut model = Model {
            is_eam: true,
            angle: 0,
            reversed: false,
            scaling: true,
            steps: 0x4000,
            range: 1 << 32,
            gear: None,
            offset: 0,
            injected: 0,
        };
        let mut gear = (1, 1, 1);
        for _ in 0..120 {
            match random.below(9) {
                0 => {
                    let steps = random.magnitude(18);
                    let expected = (4..=0x1_0000).contains(&steps);
                    assert_eq!(bench.write(0x6001, 0, steps as u32).is_ok(), expected);
                    if expected {
                        model.steps = steps.into();
                        model.offset = 0;
                    }
                }
                1 => {
                    let factor = random.below(20);
                    let range = match random.below(3) {
                        0 => random.magnitude(32) as i128,
                        _ => model.steps << factor,
                    };
                    if range >= 1 << 32 {
                        continue;
                    }
                    let power = (0..32).any(|n| model.steps << n == range);
                    let expected = power || range == 0;
                    assert_eq!(bench.write(0x6002, 0, range as u32).is_ok(), expected);
                    if expected {
                        model.range = if range == 0 { 1 << 32 } else { range };
                        model.offset = 0;
                    }
                }
                2 => {
                    let bits = random.below(8) as u32;
                    bench.write(0x6000, 0, bits).unwrap();
                    (model.reversed, model.scaling) = (bits & 1 != 0, bits & 4 != 0);
                }
                3 => {
                    let preset = random.magnitude(32) as i128;
                    let expected = preset < model.range_now();
                    assert_eq!(bench.write(0x6003, 0, preset as u32).is_ok(), expected);
                    if expected {
                        model.offset = preset - model.without_offset();
                        let offset = i128::from(bench.read(0x6509, 0) as i32);
                        let apart = (offset - model.offset).rem_euclid(model.range_now());
                        assert_eq!(apart, 0);
                        model.offset = offset;
                    }
                }
                4 => {
                    let by = random.magnitude(32) as u32;
                    bench.write(0x2116, 2, by).unwrap();
                    model.injected = by.into();
                }
                5 if round % 2 == 0 => {
                    gear = (
                        1 + random.below(2) as u32,
                        1 + random.below(32_767) as u32,
                        1 + random.below(32_767) as u32,
                    );
                    for (sub, value) in [(1, gear.0), (2, gear.1), (3, gear.2)] {
                        bench.write(0x2001, sub, value).unwrap();
                    }
                }
                6 => {
                    bench.write(0x1010, 1, SAVE).unwrap();
                    let by = random.below(1 << 30) as i64 - (1 << 29);
                    bench.power_cycle(100, by);
                    model.angle += i128::from(by) << 32;
                    model.injected = 0;
                    model.gear = (gear.0 == 2).then(|| (gear.1.into(), gear.2.into()));
                }
                _ => bench.put(&mut model, turns(&mut random)),
            }
            assert_eq!(bench.position(), model.position());
            // The simulated angle covers 2^31 revolutions in either direction.
            if model.angle.abs() > 1 << 60 {
                let back = -model.angle as i64;
                bench.put(&mut model, back);
            }
        }
    }
}

#[test]
fn en_positions() {
    let mut random = Random(0xFEDC_BA98_7654_3211);
    for _ in 0..40 {
        let mut bench = Bench::new("en580c");
        let mut model = Model {
            is_eam: false,
            angle: 0,
            reversed: false,
            scaling: true,
            steps: 0x2000,
            range: 0x2000_0000,
            gear: None,
            offset: 0,
            injected: 0,
        };
        // 6001h without the gear (MANUALS.md U-41).
        let mut own_steps = model.steps;
        // Mode, numerator, denominator.
        let mut gear = [0, 1, 1];
        let fits = |gear: [i128; 3], range: i128| gear[0] == 0 || range * gear[2] <= gear[1] << 21;
        for _ in 0..120 {
            match random.below(9) {
                0 => {
                    let steps = 1 + random.magnitude(21);
                    bench.write(0x6001, 0, steps as u32).unwrap();
                    if gear[0] == 0 {
                        own_steps = steps.into();
                        model.offset = 0;
                    }
                }
                1 => {
                    let range = random.magnitude(32) as i128;
                    let limits = (2..=1 << 31).contains(&range);
                    let expected =
                        limits && fits(gear, range) && (gear[0] == 1 || range <= model.steps << 16);
                    assert_eq!(bench.write(0x6002, 0, range as u32).is_ok(), expected);
                    if expected {
                        model.range = range;
                        model.offset = 0;
                    }
                }
                2 => {
                    let bits = random.below(8) as u32;
                    bench.write(0x6000, 0, bits).unwrap();
                    (model.reversed, model.scaling) = (bits & 1 != 0, bits & 4 != 0);
                }
                3 => {
                    let preset = random.magnitude(32) as i128;
                    let expected = preset < model.range_now();
                    assert_eq!(bench.write(0x6003, 0, preset as u32).is_ok(), expected);
                    if expected {
                        model.offset = preset - model.without_offset();
                        let offset = i128::from(bench.read(0x6509, 0) as i32);
                        let apart = (offset - model.offset).rem_euclid(model.range_now());
                        assert_eq!(apart, 0);
                        model.offset = offset;
                    }
                }
                4 => {
                    let sub = 1 + random.below(3) as usize;
                    let value = match sub {
                        1 => random.below(2),
                        _ => random.magnitude(32),
                    } as i128;
                    let mut wanted = gear;
                    wanted[sub - 1] = value;
                    let expected = (sub == 1 || value > 0) && fits(wanted, model.range);
                    let written = bench.write(0x2001, sub as u8, value as u32);
                    assert_eq!(written.is_ok(), expected, "{wanted:?} {}", model.range);
                    if expected {
                        // A gear that is off has no effect on the position.
                        let acts = gear[0] == 1 || wanted[0] == 1;
                        model.offset = if acts { 0 } else { model.offset };
                        gear = wanted;
                    }
                }
                5 => {
                    bench.write(0x1010, 1, SAVE).unwrap();
                    let by = random.below(1 << 16) as i64 - (1 << 15);
                    bench.power_cycle(100, by);
                    model.angle += i128::from(by) << 32;
                }
                _ => bench.put(&mut model, turns(&mut random)),
            }
            model.gear = (gear[0] == 1).then(|| (gear[1], gear[2]));
            model.steps = own_steps;
            if let Some((numerator, denominator)) = model.gear {
                // The minimum of the object is 1.
                model.steps = (model.range * denominator / numerator).max(1);
            }
            assert_eq!(i128::from(bench.read(0x6001, 0)), model.steps);
            assert_eq!(bench.position(), model.position());
            let raw = (model.angle * (1 << 21)).div_euclid(1 << 32);
            assert_eq!(bench.read(0x600C, 0), raw as u32);
            if model.angle.abs() > 1 << 60 {
                let back = -model.angle as i64;
                bench.put(&mut model, back);
            }
        }
    }
}

/// The mean speed over the last `interval`, from all changes so far, in thousandths of
/// a revolution per minute times microseconds.
fn way(changes: &[(u64, i32)], from: u64, to: u64) -> i128 {
    let mut way = 0;
    for (at, (since, speed)) in changes.iter().enumerate() {
        let until = changes.get(at + 1).map_or(to, |(next, _)| *next).min(to);
        let since = (*since).max(from);
        if until > since {
            way += i128::from(*speed) * i128::from(until - since);
        }
    }
    way
}

fn speed_at(changes: &[(u64, i32)], at: u64) -> i128 {
    let before = changes.iter().rev().find(|(since, _)| *since <= at);
    before.map_or(0, |(_, speed)| i128::from(*speed))
}

#[test]
fn en_speeds_and_accelerations() {
    let mut random = Random(0x0F1E_2D3C_4B5A_6971);
    for _ in 0..20 {
        let mut bench = Bench::new("en580c");
        let mut parameters = [[0; 2]; 2];
        let interval = 1 + random.below(400);
        let steps = 1 + random.magnitude(21) as u32;
        bench.write(0x6001, 0, steps).unwrap();
        for (of, index) in [0x6031, 0x6041].into_iter().enumerate() {
            bench.write(index, 2, interval as u32).unwrap();
            for sub in [3, 4] {
                let value = 1 + random.magnitude(16) as u32;
                bench.write(index, sub, value).unwrap();
                parameters[of][usize::from(sub) - 3] = i128::from(value);
            }
        }
        let mut changes = vec![(0, 0)];
        bench.wait(1000);
        for _ in 0..60 {
            let milli_rpm = turns(&mut random) as i32;
            bench.rpm(milli_rpm);
            changes.push((bench.now.as_micros(), milli_rpm));
            bench.wait(10 + random.below(200));
            let now = bench.now.as_micros();
            let from = now - interval * 1000;
            let [speed, acceleration] = parameters;
            let time = i128::from(interval) * 1000;
            let expected = way(&changes, from, now) * i128::from(steps) * speed[0];
            // Rounded towards zero, like a division.
            let expected = expected / (60_000 * time * speed[1]);
            let held = |value: i128| value.clamp(-0x8000, 0x7FFF) as i16;
            assert_eq!(bench.read16(0x6030, 1), held(expected));
            let change = speed_at(&changes, now) - speed_at(&changes, from);
            let expected = change * 1_000_000 * i128::from(steps) * acceleration[0];
            let expected = expected / (60_000 * time * acceleration[1]);
            assert_eq!(bench.read16(0x6040, 1), held(expected));
        }
    }
}
