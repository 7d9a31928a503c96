//! Tests when a family sees its faults, and for how long.

use super::family::bench;
use super::*;

/// A family whose reports begin and end at different times.
static TIMES: EncoderProfile = EncoderProfile {
    reports: &[
        report(Fault::Memory, 1, Appears::Startup),
        report(Fault::Memory, 2, Appears::Runtime),
        Report {
            off_ms: 1000,
            ..report(Fault::BatteryEmpty, 3, Appears::Startup)
        },
        report(Fault::Speed, 4, Appears::Runtime),
        Report {
            until: Until::Reboot,
            ..report(Fault::Temperature, 5, Appears::Always)
        },
        Report {
            until: Until::Ever,
            injection: Some(77),
            ..report(Fault::Supervision, 6, Appears::Always)
        },
        Report {
            injection: Some(78),
            ..report(Fault::Internal, 7, Appears::Injected)
        },
        report(Fault::Watchdog, 8, Appears::Always),
        report(Fault::Watchdog, 8, Appears::Always),
    ],
    objects: &[(Address::new(0x2101, 0), Role::InjectedError)],
    by_support: false,
    ..EncoderProfile::CIA406
};

const fn report(fault: Fault, code: u16, appears: Appears) -> Report {
    Report {
        fault,
        code,
        alarm: 1 << code,
        warning: 1 << (15 - code),
        appears,
        ..Report::BASE
    }
}

/// Codes of the errors that began, and of those that ended as negative numbers.
fn news(bench: &mut Bench) -> Vec<i32> {
    bench.with(|encoder, cx| encoder.tick(cx));
    let change = |change| match change {
        Change::Raised(error) => i32::from(error.code),
        Change::Cleared { code, .. } => -i32::from(code),
    };
    bench.errors().into_iter().map(change).collect()
}

fn restart(bench: &mut Bench, reset: Reset) -> Vec<i32> {
    bench.errors();
    bench.reset(reset);
    news(bench)
}

#[test]
fn faults_are_seen_when_a_family_looks_for_them() {
    let mut bench = bench(&TIMES);
    bench.encoder.set_fault(Fault::Memory, true);
    assert_eq!(news(&mut bench), [2], "it came at run time");
    assert_eq!(bench.read(0x6503, 0), 1 << 2);
    assert_eq!(bench.read(0x6505, 0), 1 << 13);
    assert_eq!(
        restart(&mut bench, Reset::Node),
        [1],
        "it is there at the start"
    );
    assert_eq!(bench.read(0x6503, 0), 1 << 1);
    bench.encoder.set_fault(Fault::Speed, true);
    assert_eq!(news(&mut bench), [4]);
    assert_eq!(bench.read(0x6503, 0), 1 << 1 | 1 << 4);
    bench.encoder.set_fault(Fault::Memory, false);
    assert_eq!(news(&mut bench), [-1]);
    bench.encoder.set_fault(Fault::Memory, true);
    assert_eq!(news(&mut bench), [2], "it came again at run time");
    bench.encoder.set_fault(Fault::Speed, false);
    bench.encoder.set_fault(Fault::Memory, false);
    assert_eq!(news(&mut bench), [-2, -4]);
    assert_eq!((bench.read(0x6503, 0), bench.read(0x6505, 0)), (0, 0));
}

#[test]
fn a_battery_is_tested_if_power_was_off_long_enough() {
    let mut bench = bench(&TIMES);
    bench.encoder.set_fault(Fault::BatteryEmpty, true);
    assert_eq!(news(&mut bench), [0; 0], "nobody looks");
    assert_eq!(restart(&mut bench, Reset::Node), [0; 0], "power was there");
    for (off_ms, found) in [(999, &[][..]), (1000, &[3]), (5000, &[3])] {
        bench.encoder.power_off(bench.now);
        bench.now = bench.now.plus_millis(off_ms);
        assert_eq!(restart(&mut bench, Reset::PowerOn), found, "{off_ms}");
    }
    assert_eq!(
        restart(&mut bench, Reset::PowerOn),
        [3],
        "nobody knows how long"
    );
    let mut bench = super::family::bench(&TIMES);
    bench.encoder.set_fault(Fault::Memory, true);
    bench.encoder.power_off(bench.now);
    assert_eq!(restart(&mut bench, Reset::PowerOn), [1], "at every start");
}

#[test]
fn reports_last_as_the_family_specifies() {
    let mut bench = bench(&TIMES);
    bench.encoder.set_fault(Fault::Temperature, true);
    bench.encoder.set_fault(Fault::Supervision, true);
    assert_eq!(news(&mut bench), [5, 6]);
    bench.encoder.set_fault(Fault::Temperature, false);
    bench.encoder.set_fault(Fault::Supervision, false);
    assert_eq!(news(&mut bench), [0; 0], "both last");
    assert_eq!(
        restart(&mut bench, Reset::Node),
        [6],
        "one of them for ever"
    );
    assert_eq!(restart(&mut bench, Reset::PowerOn), [6]);
}

#[test]
fn a_watchdog_is_seen_after_the_reset_and_until_it_is_repaired() {
    let mut bench = bench(&TIMES);
    bench.encoder.set_fault(Fault::Watchdog, true);
    assert!(bench.encoder.is_broken(Fault::Watchdog));
    assert_eq!(news(&mut bench), [0; 0]);
    assert_eq!(restart(&mut bench, Reset::Node), [8, 8], "two rows say so");
    assert!(bench.encoder.is_broken(Fault::Watchdog));
    assert!(!bench.encoder.is_broken(Fault::Speed));
    bench.encoder.set_fault(Fault::Speed, false);
    assert_eq!(news(&mut bench), [0; 0], "another fault ended");
    bench.encoder.set_fault(Fault::Watchdog, false);
    assert_eq!(news(&mut bench), [-8], "the two are one error for the bus");
    assert!(!bench.encoder.is_broken(Fault::Watchdog));
}

#[test]
fn a_damaged_memory_is_a_fault_until_a_save_succeeds() {
    let mut bench = bench(&TIMES);
    bench.encoder.storage_is(false);
    assert_eq!(news(&mut bench), [2]);
    bench.encoder.set_fault(Fault::Memory, true);
    bench.encoder.storage_is(true);
    assert_eq!(news(&mut bench), [0; 0], "it is broken, too");
    bench.encoder.set_fault(Fault::Memory, false);
    assert_eq!(news(&mut bench), [-2]);
}

#[test]
fn errors_are_injected_by_their_codes() {
    let mut bench = bench(&TIMES);
    assert_eq!(bench.write(0x2101, 0, 76), Err(AbortCode::ValueRange));
    assert_eq!(bench.write(0x2101, 0, 78), Ok(()));
    assert_eq!(news(&mut bench), [7]);
    assert_eq!(bench.write(0x2101, 0, 77), Ok(()));
    assert_eq!(news(&mut bench), [6], "they add up");
    assert_eq!(restart(&mut bench, Reset::Node), [6], "for ever");
    assert_eq!(bench.write(0x2101, 0, 0), Ok(()));
    assert_eq!(news(&mut bench), [-6]);
}

/// A sensor that fails with this fault.
struct Broken(Fault);

impl PositionSource for Broken {
    fn sample(&mut self, _: Instant) -> Result<Angle, Fault> {
        Err(self.0)
    }
}

#[test]
fn a_silent_sensor_is_an_alarm_in_every_family() {
    let alarm = |profile, fault| {
        let tables = tables(0x2000_0000);
        let mut values = vec![0; tables.dictionary().store_len()];
        let dictionary = tables.dictionary();
        let mut store = Store::new(&dictionary, &mut values, NodeId::ONE).unwrap();
        store.reset(|_| true);
        let mut signals = Signals::default();
        let mut cx = Context {
            store: &mut store,
            now: Instant::ZERO,
            signals: &mut signals,
        };
        let shaft: Sampled<_, 3> = Sampled::new(Broken(fault), od_wire::Duration::from_millis(1));
        let mut encoder = Encoder::new(profile, shaft);
        encoder.reset(&mut cx, Reset::PowerOn);
        encoder.tick(&mut cx);
        let codes = core::iter::from_fn(|| signals.errors.pop()).map(|change| match change {
            Change::Raised(error) => error.code,
            Change::Cleared { .. } => 0,
        });
        codes.collect::<Vec<_>>()
    };
    assert_eq!(alarm(&TIMES, Fault::Temperature), [5], "its own alarm");
    assert_eq!(alarm(&TIMES, Fault::Speed), [4]);
    let no_angle = EncoderProfile::NO_ANGLE.code;
    assert_eq!(
        alarm(&TIMES, Fault::BatteryEmpty),
        [no_angle],
        "only at a start"
    );
    assert_eq!(alarm(&TIMES, Fault::Internal), [no_angle], "injected only");
    assert_eq!(alarm(&TIMES, Fault::Position), [no_angle], "no report");
    let battery = EncoderProfile::CIA406.reports[1].code;
    assert_eq!(
        alarm(&EncoderProfile::CIA406, Fault::Battery),
        [battery, no_angle],
        "no alarm"
    );
}

#[test]
fn a_memory_that_is_damaged_at_the_start_is_reported_at_the_start() {
    let mut bench = bench(&TIMES);
    bench.encoder.storage_is(false);
    assert_eq!(restart(&mut bench, Reset::Node), [1]);
    bench.encoder.storage_is(true);
    assert_eq!(news(&mut bench), [-1]);
    assert_eq!(restart(&mut bench, Reset::Node), [0; 0]);
}
