//! The sources of errors in manual 001, chapter 9.5, injected and real.

use odkit::encoder::Fault;
use odkit::nmt::State;

use crate::bench::{Bench, OUT_OF_RANGE, SAVE};

/// Code of 2116h, EMCY code, 1001h, 6503h, 6505h, 2117h; whether the error lasts after a restart.
type Row = (u32, u16, u8, u16, u16, u16, bool);

const COMMON: [Row; 9] = [
    (0x0008_0020, 0x4200, 0x09, 0, 0, 0x2000, false),
    (0x0001_0024, 0x5100, 0x01, 0x0003, 0, 0x0C00, false),
    (0x0008_0024, 0x5100, 0, 0, 0x0008, 0x0004, false),
    (0x0008_0025, 0x6100, 0, 0, 0x0004, 0x0002, false),
    (0x0001_0009, 0xFF04, 0x01, 0x1001, 0, 0x4400, false),
    (0x0008_0009, 0xFF04, 0, 0, 0x2000, 0x0020, false),
    (0x0008_0021, 0xFF05, 0, 0, 0x0001, 0x0001, false),
    (0x0008_0022, 0xFF06, 0, 0, 0x4000, 0x0040, false),
    (0x0008_0023, 0xFF07, 0, 0, 0x8000, 0x0080, false),
];

const SINGLE: [Row; 5] = [
    (0x0008_0005, 0xFF00, 0, 0, 0x0010, 0x0008, false),
    (0x0001_0004, 0xFF01, 0x01, 0x8001, 0, 0x8400, false),
    (0x0008_0004, 0xFF01, 0, 0, 0x2000, 0x0020, false),
    (0x0004_0003, 0xFF02, 0, 0, 0x1000, 0x0010, false),
    (0x0008_0003, 0xFF02, 0, 0, 0x1000, 0x0010, false),
];

const REDUNDANT: [Row; 9] = [
    (0x0004_001C, 0xFF00, 0, 0, 0x0010, 0x0008, false),
    (0x0001_0004, 0xFF01, 0x01, 0x8001, 0, 0x8400, true),
    (0x0008_0004, 0xFF01, 0, 0, 0x2000, 0x0020, true),
    (0x0001_001A, 0xFF02, 0x01, 0x0001, 0, 0x0400, true),
    (0x0008_001A, 0xFF02, 0, 0, 0x1000, 0x0010, true),
    (0x0001_001B, 0xFF03, 0x01, 0x0001, 0, 0x0400, true),
    (0x0008_001B, 0xFF03, 0, 0, 0x1000, 0x0010, true),
    (0x0001_0014, 0xFF17, 0x01, 0x8001, 0, 0x8400, true),
    (0x0008_0014, 0xFF17, 0, 0, 0x2000, 0x0020, true),
];

fn shown(bench: &mut Bench) -> [u32; 4] {
    [0x1001, 0x6503, 0x6505, 0x2117].map(|index| bench.read(index, 0))
}

#[test]
fn each_code_has_the_effects_of_its_row() {
    for (name, own, others) in [
        ("eam_mt", &SINGLE[..], &REDUNDANT[..]),
        ("eam_st", &SINGLE[..], &REDUNDANT[..]),
        ("eam_red", &REDUNDANT[..], &SINGLE[..]),
    ] {
        for &(code, emcy, register, alarms, warnings, diagnosis, lasts) in COMMON.iter().chain(own)
        {
            let mut bench = Bench::new(name);
            bench.emcys();
            bench.write(0x2116, 1, code).unwrap();
            bench.write(0x2116, 1, code).unwrap();
            let what = format!("{name} {code:08X}");
            assert_eq!(
                bench.emcys(),
                [(emcy, register, alarms, warnings)],
                "{what}"
            );
            let expected = [
                register.into(),
                alarms.into(),
                warnings.into(),
                diagnosis.into(),
            ];
            assert_eq!(shown(&mut bench), expected, "{what}");
            assert_eq!(bench.read(0x1003, 1), u32::from(emcy), "{what}");
            bench.nmt(0x81);
            let again = [(emcy, register, alarms, warnings)];
            assert_eq!(bench.emcys(), &again[..usize::from(lasts)], "{what}");
            assert_eq!(bench.read(0x2116, 1), 0, "{what}");
            assert_eq!(
                shown(&mut bench),
                if lasts { expected } else { [0; 4] },
                "{what}"
            );
            bench.write(0x2116, 1, code).unwrap();
            bench.emcys();
            bench.write(0x2116, 1, 0).unwrap();
            assert_eq!(bench.emcys(), [(0, 0, 0, 0)], "{what}");
            assert_eq!(shown(&mut bench), [0; 4], "{what}");
        }
        let mut bench = Bench::new(name);
        let strange = others.iter().map(|row| row.0);
        for code in strange.chain([1, 0x20, 0x0008_0026, 0x0002_0024, 0xFFFF_FFFF]) {
            if own.iter().all(|row| row.0 != code) {
                assert_eq!(
                    bench.write(0x2116, 1, code),
                    OUT_OF_RANGE,
                    "{name} {code:08X}"
                );
            }
        }
    }
}

#[test]
fn codes_add_up_and_zero_ends_them_all() {
    let mut bench = Bench::new("eam_mt");
    bench.emcys();
    for code in [
        0x0001_0024,
        0x0008_0024,
        0x0008_0020,
        0x0001_0004,
        0x0008_0009,
    ] {
        bench.write(0x2116, 1, code).unwrap();
    }
    assert_eq!(
        bench.emcys(),
        [
            (0x5100, 0x01, 0x0003, 0),
            (0x5100, 0x01, 0x0003, 0x0008),
            (0x4200, 0x09, 0x0003, 0x0008),
            (0xFF01, 0x09, 0x8003, 0x0008),
            (0xFF04, 0x09, 0x8003, 0x2008),
        ]
    );
    assert_eq!(shown(&mut bench), [0x09, 0x8003, 0x2008, 0xAC24]);
    assert_eq!(bench.read(0x2116, 1), 0x0008_0009);
    bench.write(0x2116, 1, 0).unwrap();
    assert_eq!(bench.emcys(), [(0, 0, 0, 0)], "once, when no error is left");
    assert_eq!(shown(&mut bench), [0; 4]);
    // All at once: no queue may lose one.
    let mut bench = Bench::new("eam_red");
    for row in COMMON.iter().chain(&REDUNDANT) {
        bench.write(0x2116, 1, row.0).unwrap();
    }
    assert_eq!(shown(&mut bench)[..3], [0x09, 0x9003, 0xF01D]);
    bench.write(0x2116, 1, 0).unwrap();
    assert_eq!(shown(&mut bench), [0; 4]);
}

#[test]
fn a_temperature_warning_begins_and_ends() {
    let mut bench = Bench::new("eam_mt");
    bench.emcys();
    bench.change(|encoder, _| encoder.set_fault(Fault::Temperature, true));
    bench.change(|encoder, _| encoder.set_fault(Fault::Temperature, false));
    assert_eq!(bench.emcys(), [(0x4200, 0x09, 0, 0), (0, 0, 0, 0)]);
    // A condition from before the start is detected, too.
    bench.change(|encoder, _| encoder.set_fault(Fault::Temperature, true));
    bench.nmt(0x81);
    let hot = (0x4200, 0x09, 0, 0);
    assert_eq!(bench.emcys(), [hot, hot]);
}

#[test]
fn a_memory_error_at_the_start_or_later() {
    let mut bench = Bench::new("eam_mt");
    bench.emcys();
    bench.change(|encoder, _| encoder.set_fault(Fault::Memory, true));
    assert_eq!(bench.emcys(), [(0x5100, 0, 0, 0x0008)]);
    bench.change(|encoder, _| encoder.set_fault(Fault::Memory, false));
    assert_eq!(bench.emcys(), [], "until the next start");
    bench.change(|encoder, _| encoder.set_fault(Fault::Memory, true));
    bench.nmt(0x81);
    assert_eq!(bench.emcys(), [(0x5100, 0x01, 0x0003, 0)]);
    bench.change(|encoder, _| encoder.set_fault(Fault::Memory, false));
    assert_eq!(shown(&mut bench)[..3], [1, 3, 0]);
    bench.nmt(0x81);
    assert_eq!((bench.emcys(), shown(&mut bench)), (Vec::new(), [0; 4]));
}

#[test]
fn the_watchdog_is_reported_after_the_boot_up() {
    let mut bench = Bench::new("eam_mt");
    bench.change(|encoder, _| encoder.set_fault(Fault::Watchdog, true));
    bench.emcys();
    bench.nmt(0x81);
    let frames: Vec<u32> = bench.heard.iter().map(|frame| frame.id().raw()).collect();
    assert_eq!(frames, [0x701, 0x81]);
    assert_eq!(bench.emcys(), [(0x6100, 0, 0, 0x0004)]);
    bench.nmt(0x81);
    assert_eq!(bench.emcys(), []);
}

#[test]
fn a_redundant_battery_is_tested_while_power_is_off() {
    let mut bench = Bench::new("eam_red");
    bench.emcys();
    bench.change(|encoder, _| encoder.set_fault(Fault::Battery, true));
    bench.nmt(0x81);
    assert_eq!(bench.emcys(), [], "there was power all the time");
    bench.power_cycle(10_999, 0);
    assert_eq!(bench.emcys(), []);
    bench.power_cycle(11_000, 0);
    assert_eq!(bench.emcys(), [(0xFF00, 0, 0, 0x0010)]);
    bench.power_cycle(5_000, 0);
    assert_eq!(bench.emcys(), [], "too short to see it again");
    bench.change(|encoder, _| encoder.set_fault(Fault::BatteryEmpty, true));
    assert_eq!(bench.emcys(), []);
    bench.power_cycle(999, 0);
    assert_eq!(bench.emcys(), []);
    bench.power_cycle(1_000, 0);
    let empty = (0xFF01, 0x01, 0x8001, 0);
    assert_eq!(bench.emcys(), [empty]);
    bench.change(|encoder, _| encoder.set_fault(Fault::BatteryEmpty, false));
    bench.power_cycle(60_000, 0);
    assert_eq!(bench.emcys()[0], (0xFF00, 0, 0, 0x0010));
    assert_eq!(
        shown(&mut bench)[..3],
        [1, 0x8001, 0x0010],
        "nothing resets it"
    );
}

#[test]
fn the_battery_of_an_encoder_that_is_not_redundant_is_monitored_always() {
    let mut bench = Bench::new("eam_mt");
    bench.emcys();
    bench.change(|encoder, _| encoder.set_fault(Fault::Battery, true));
    bench.change(|encoder, _| encoder.set_fault(Fault::BatteryEmpty, true));
    assert_eq!(
        bench.emcys(),
        [(0xFF00, 0, 0, 0x0010), (0xFF01, 0, 0, 0x2010)]
    );
    bench.nmt(0x81);
    assert_eq!(
        bench.emcys(),
        [(0xFF00, 0, 0, 0x0010), (0xFF01, 0x01, 0x8001, 0x0010)]
    );
}

#[test]
fn the_error_behaviour_follows_an_injected_error() {
    let mut bench = Bench::new("eam_mt");
    bench.write(0x1029, 2, 0).unwrap();
    bench.nmt(1);
    bench.write(0x2116, 1, 0x0008_0023).unwrap();
    assert_eq!(
        bench.state(),
        State::Operational,
        "a warning is not an error"
    );
    bench.write(0x2116, 1, 0x0001_0009).unwrap();
    assert_eq!(bench.state(), State::PreOperational);
    bench.nmt(1);
    assert_eq!(bench.state(), State::PreOperational, "as long as it lasts");
    bench.write(0x2116, 1, 0).unwrap();
    bench.nmt(1);
    assert_eq!(bench.state(), State::Operational);
}

#[test]
fn injected_errors_are_not_saved() {
    let mut bench = Bench::new("eam_mt");
    bench.write(0x2116, 1, 0x0001_0009).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle(100, 0);
    assert_eq!((bench.read(0x2116, 1), shown(&mut bench)), (0, [0; 4]));
}
