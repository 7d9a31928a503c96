//! A host that only sets positions, which the device samples.

use od_devices::encoders;
use od_sim::VirtualDevice;
use odkit::Address;
use odkit::encoder::{Angle, Fault, PositionSource, Role, Sampled};
use odkit::{DeviceKind, Duration, Instant, NodeId};

use crate::bench::Bench;

/// A sensor that returns what the host sets, in its own steps, or fails.
struct Set {
    steps: u32,
    raw: Result<i64, Fault>,
}

impl PositionSource for Set {
    fn sample(&mut self, _: Instant) -> Result<Angle, Fault> {
        let turns = |raw: i64| (i128::from(raw) << 32) / i128::from(self.steps);
        self.raw.map(|raw| Angle::from_fractions(turns(raw) as i64))
    }
}

type Shaft = Sampled<Set, 255>;

/// A device that samples its shaft every millisecond.
fn bench(kind: &DeviceKind) -> Bench<Shaft> {
    let steps = kind.encoder().unwrap().sensor_of(kind.dictionary).steps;
    let sensor = Set { steps, raw: Ok(0) };
    Bench::on(Sampled::new(sensor, Duration::from_millis(1)), kind.name)
}

/// The devices with a speed in steps, and their integration time in milliseconds.
fn with_speed() -> impl Iterator<Item = (&'static DeviceKind, u64)> {
    let speed = Address::new(0x6030, 1);
    encoders().filter_map(move |kind| {
        let Role::Movement(movement) = kind.encoder()?.role(speed)? else {
            return None;
        };
        let entry = kind.dictionary.find(movement.interval).ok()?;
        Some((kind, entry.default.integer(1)? as u64))
    })
}

impl Bench<Shaft> {
    fn set_position(&mut self, raw: i64) {
        self.node.application.shaft.source.raw = Ok(raw);
    }

    /// 6030h:01, 16 or 32 bits.
    fn speed(&mut self) -> i32 {
        match self.node.application.profile().object(Role::RawPosition) {
            // The EN580C.
            Some(_) => self.read16(0x6030, 1).into(),
            None => self.read(0x6030, 1) as i32,
        }
    }
}

#[test]
fn positions_set_by_a_host_give_a_speed() {
    let mut names = Vec::new();
    for (kind, interval) in with_speed() {
        names.push(kind.name);
        let mut bench = bench(kind);
        // 6001h equals the resolution of the sensor, so their steps are equal.
        bench
            .write(0x6001, 0, bench.node.application.sensor().steps)
            .unwrap();
        // The EN580C has 16 bits for 100,000 steps per second.
        let divider = if bench.write(0x6031, 4, 10).is_ok() {
            10
        } else {
            1
        };
        for ms in 1..=2 * interval {
            bench.set_position(100 * ms as i64);
            bench.wait(1);
            assert_eq!(bench.position(), 100 * ms as u32, "{} {ms}", kind.name);
            let expected = if ms < interval { 0 } else { 100_000 / divider };
            assert_eq!(bench.speed(), expected, "{} {ms}", kind.name);
        }
        // It stops, and turns in the other direction.
        bench.wait(interval);
        assert_eq!(bench.speed(), 0, "{}", kind.name);
        for ms in 1..=interval {
            bench.set_position(100 * (2 * interval as i64 - ms as i64));
            bench.wait(1);
        }
        assert_eq!(bench.speed(), -100_000 / divider, "{}", kind.name);
    }
    assert_eq!(names, ["eam_mt", "eam_st", "eam_red", "en580c"]);
}

/// The bench's shaft, which a host moves every millisecond without a speed.
#[test]
fn positions_set_on_the_bench_give_a_speed() {
    for (kind, interval) in with_speed() {
        let mut device = VirtualDevice::new(kind, NodeId::ONE);
        device.power_on(Instant::ZERO);
        let steps = f64::from(kind.encoder().unwrap().sensor_of(kind.dictionary).steps);
        let shown = kind.dictionary.entry(0x6001, 0).unwrap();
        let scale = shown.default.integer(1).unwrap() as f64 / steps;
        for ms in 0..=3 * interval {
            let now = Instant::from_millis(ms);
            if ms <= 2 * interval {
                device.set_position(100 * ms, now);
            }
            let value = device.read(Address::new(0x6030, 1), now);
            let mut bytes = [0; 4];
            bytes[..value.len()].copy_from_slice(&value);
            let expected = match ms {
                ms if ms < interval => 0,
                ms if ms <= 2 * interval => (100_000.0 * scale) as u32,
                ms if ms < 3 * interval => continue,
                _ => 0,
            };
            assert_eq!(u32::from_le_bytes(bytes), expected, "{} {ms}", kind.name);
        }
    }
}

#[test]
fn a_shaft_that_jitters_is_within_a_step_per_interval() {
    for (kind, interval) in with_speed() {
        let mut bench = bench(kind);
        let steps = bench.node.application.sensor().steps;
        bench.write(0x6001, 0, steps).unwrap();
        let jitter = |ms: u64| (ms * 7919 % 13) as i64 - 6;
        let position = |ms: u64| 17 * ms as i64 + jitter(ms);
        for ms in 1..500 {
            bench.set_position(position(ms));
            bench.wait(1);
            if ms <= interval {
                continue;
            }
            let per_step = 1000 / interval as i64;
            let exact = (position(ms) - position(ms - interval)) * per_step;
            let error = i64::from(bench.speed()) - exact;
            assert!(error.abs() <= per_step, "{} {ms}: {error}", kind.name);
        }
    }
}

#[test]
fn a_preset_or_a_new_resolution_is_not_a_movement() {
    for (kind, interval) in with_speed() {
        let mut bench = bench(kind);
        for ms in 1..=2 * interval as i64 {
            bench.set_position(40 * ms);
            bench.wait(1);
        }
        let (speed, acceleration) = (bench.speed(), bench.read16(0x6040, 1));
        assert!(speed > 0);
        for write in [(0x6003, 5), (0x6003, 2000), (0x6000, 4)] {
            bench.write(write.0, 0, write.1).unwrap();
            assert_eq!(bench.speed(), speed, "{} {write:X?}", kind.name);
            assert_eq!(bench.read16(0x6040, 1), acceleration, "{}", kind.name);
        }
        bench.write(0x6000, 0, 5).unwrap();
        assert_eq!(bench.speed(), -speed, "{}", kind.name);
        bench.write(0x6000, 0, 4).unwrap();
        let resolution = bench.read(0x6001, 0);
        bench.write(0x6001, 0, resolution / 2).unwrap();
        assert!((bench.speed() - speed / 2).abs() <= 1, "{}", kind.name);
    }
}

#[test]
fn an_acceleration_comes_from_the_samples() {
    for (kind, _) in with_speed() {
        let mut bench = bench(kind);
        let steps = f64::from(bench.node.application.sensor().steps);
        bench.write(0x6001, 0, 0x1_0000).unwrap();
        bench.write(0x6041, 4, 1092).unwrap();
        // 6000 revolutions per minute more in a second, as in the example of the manuals.
        for ms in 1..=400 {
            let turns = 50.0 * (ms as f64 / 1000.0).powi(2);
            bench.set_position((turns * steps) as i64);
            bench.wait(1);
        }
        let found = bench.read16(0x6040, 1);
        assert!((found - 6001).abs() <= 6, "{}: {found}", kind.name);
    }
}

#[test]
fn a_sensor_fault_is_an_alarm_until_a_sample_succeeds() {
    for kind in encoders() {
        let mut bench = bench(kind);
        bench.set_position(1000);
        bench.wait(1);
        let position = bench.position();
        assert!(position > 0);
        assert_eq!(
            (bench.emcys().len(), bench.read(0x6503, 0)),
            (0, 0),
            "{}",
            kind.name
        );
        bench.node.application.shaft.source.raw = Err(Fault::Position);
        bench.wait(1);
        let emcys = bench.emcys();
        // Every family has bit 0 for a position that is not reliable.
        assert!(matches!(emcys[..], [(0x7320, _, 1, 0)]), "{emcys:X?}");
        assert_eq!(bench.read(0x6503, 0), 1, "{}", kind.name);
        assert_eq!(bench.position(), position, "{}: the last one", kind.name);
        bench.wait(20);
        assert_eq!(bench.emcys(), [], "{}: once", kind.name);
        bench.set_position(2000);
        bench.wait(1);
        assert_eq!(bench.emcys(), [(0, 0, 0, 0)], "{}", kind.name);
        assert!(bench.position() > position, "{}", kind.name);
    }
}

#[test]
fn a_fault_that_is_a_warning_is_an_alarm_if_there_is_no_position() {
    let mut bench = bench(od_devices::find("eam_mt").unwrap());
    bench.node.application.shaft.source.raw = Err(Fault::SingleturnStrength);
    bench.wait(1);
    let [warning, alarm] = bench.emcys()[..] else {
        panic!("two EMCYs")
    };
    assert_eq!((warning.0, warning.3), (0xFF06, 0x4000));
    assert_eq!((alarm.0, alarm.2), (0x7320, 1));
    bench.set_position(0);
    bench.wait(1);
    // The warning lasts until the next start.
    assert_eq!((bench.read(0x6503, 0), bench.read(0x6505, 0)), (0, 0x4000));
}
