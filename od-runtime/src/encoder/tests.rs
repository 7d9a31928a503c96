//! The encoder behind a dictionary, without a node.

use std::vec;
use std::vec::Vec;

use od_model::patch::{self, Edit, Raw, Target};
use od_model::{Access, DataType, Description, ObjectCode, Tables};

use od_model::Address;

use super::*;
use crate::{AbortCode, Application, Context, ErrorChange, NodeId, Reset, Signals, Store};

/// A family like that of the bus covers.
static PROFILE: EncoderProfile = EncoderProfile {
    total: Total::Steps,
    signed_offset: false,
    below_limit: AbortCode::ValueRange,
    lists: &[(Address::new(0x1029, 1), &[0, 1, 2, 3])],
    options: Some(Options {
        index: 0x2110,
        keep_offset: 1 << 9,
        delay_timer: 1 << 8,
        delay_ms: 2,
        ..Options::NONE
    }),
    node_id: Some(0x2101),
    bit_rate: Some(0x2100),
    bit_rates: &[10, 20, 50, 100, 125, 250, 500, 800, 1000],
    switch_rates: &[10, 20, 50, 125, 250, 500, 800, 1000],
    seconds: Some(Address::new(0x2201, 2)),
    reports: &[
        Report {
            counter: Some(Address::new(0x2201, 1)),
            register: 0x81,
            ..EncoderProfile::CIA406.reports[0]
        },
        EncoderProfile::CIA406.reports[1],
        Report {
            counter: Some(Address::new(0x2201, 3)),
            ..EncoderProfile::CIA406.reports[2]
        },
    ],
    ..EncoderProfile::CIA406
};

/// A device like gxmm, or like gxam.
fn tables(range: i128) -> Tables {
    use Access::{Ro, Rw};
    use DataType::{Unsigned8, Unsigned16, Unsigned32};
    let mut edits = Vec::new();
    for index in [0x1018, 0x1029, 0x1800, 0x2201] {
        edits.push(
            Edit::add(Target::object(index))
                .code(ObjectCode::Record)
                .name("Record"),
        );
    }
    let warnings = if range == 0x2000 { 4 } else { 0x14 };
    for (index, sub, data_type, access, default) in [
        (0x1018, 4, Unsigned32, Ro, 1),
        (0x1029, 1, Unsigned8, Rw, 1),
        (0x1800, 5, Unsigned16, Rw, 0x203),
        (0x2100, 0, Unsigned8, Rw, 2),
        (0x2101, 0, Unsigned8, Rw, 1),
        (0x2110, 0, Unsigned32, Rw, 8),
        (0x2201, 1, Unsigned32, Ro, 0),
        (0x2201, 2, Unsigned32, Ro, 0),
        (0x2201, 3, Unsigned32, Ro, 0),
        (0x6000, 0, Unsigned16, Rw, 4),
        (0x6001, 0, Unsigned32, Rw, 0x2000),
        (0x6002, 0, Unsigned32, Rw, range),
        (0x6003, 0, Unsigned32, Rw, 0),
        (0x6004, 0, Unsigned32, Ro, 0),
        (0x6200, 0, Unsigned16, Rw, 0x203),
        (0x6500, 0, Unsigned16, Ro, 4),
        (0x6501, 0, Unsigned32, Ro, 0x2000),
        (0x6502, 0, Unsigned32, Ro, range),
        (0x6503, 0, Unsigned16, Ro, 0),
        (0x6504, 0, Unsigned16, Ro, 1),
        (0x6505, 0, Unsigned16, Ro, 0),
        (0x6506, 0, Unsigned16, Ro, warnings),
        (0x6508, 0, Unsigned32, Ro, 0),
        (0x6509, 0, Unsigned32, Ro, 0),
        (0x650B, 0, Unsigned32, Ro, 1),
    ] {
        let target = match index {
            0x1018 | 0x1029 | 0x1800 | 0x2201 => Target::member(index, sub),
            _ => Target::object(index),
        };
        edits.push(
            Edit::add(target)
                .name("Value")
                .data_type(data_type)
                .access(access)
                .default(Raw::Integer(default)),
        );
    }
    let mut description = Description::default();
    let findings = patch::apply(&mut description, &edits);
    assert!(findings.is_empty(), "{findings:?}");
    Tables::new(&description)
}

struct Bench {
    tables: Tables,
    values: Vec<u8>,
    encoder: Encoder,
    now: Instant,
    signals: Signals,
}

impl Bench {
    fn new(range: i128) -> Self {
        let tables = tables(range);
        let values = vec![0; tables.dictionary().store_len()];
        let mut bench = Self {
            tables,
            values,
            encoder: Encoder::new(&PROFILE),
            now: Instant::ZERO,
            signals: Signals::default(),
        };
        bench.reset(Reset::PowerOn);
        bench
    }

    fn with<R>(&mut self, call: impl FnOnce(&mut Encoder, &mut Context<'_, '_>) -> R) -> R {
        let dictionary = self.tables.dictionary();
        let mut store = Store::new(dictionary, &mut self.values, NodeId::ONE).unwrap();
        let mut cx = Context {
            store: &mut store,
            now: self.now,
            signals: &mut self.signals,
        };
        call(&mut self.encoder, &mut cx)
    }

    fn reset(&mut self, reset: Reset) {
        self.with(|encoder, cx| {
            if matches!(reset, Reset::PowerOn | Reset::Node) {
                cx.store.reset(|_| true);
            }
            encoder.reset(cx, reset);
            encoder.tick(cx);
        });
    }

    fn write(&mut self, index: u16, sub: u8, value: u64) -> Result<(), AbortCode> {
        let address = Address::new(index, sub);
        self.with(|encoder, cx| {
            let entry = cx.store.dictionary().find(address).unwrap();
            let size = entry.data_type.size().unwrap();
            encoder.validate(cx, address, &value.to_le_bytes()[..size])?;
            cx.store.set_unsigned(address, value);
            encoder.written(cx, address);
            Ok(())
        })
    }

    fn read(&mut self, index: u16, sub: u8) -> u64 {
        self.with(|encoder, cx| {
            encoder.refresh(cx, Address::new(index, sub)).unwrap();
            cx.store.unsigned(index, sub)
        })
    }

    fn position(&mut self) -> u64 {
        self.read(0x6004, 0)
    }

    fn at(&mut self, raw: u64) {
        self.encoder.set_raw_position(self.now, raw);
    }

    fn errors(&mut self) -> Vec<ErrorChange> {
        core::iter::from_fn(|| self.signals.errors.pop()).collect()
    }
}

#[test]
fn the_trace_of_the_manual() {
    let mut bench = Bench::new(0x2000_0000);
    bench.at(0x7_9592);
    assert_eq!(bench.position(), 0x7_9592);
    bench.write(0x6002, 0, 0x1000_0000).unwrap();
    bench.write(0x6001, 0, 0x1000).unwrap();
    assert_eq!(bench.position(), 0x3_CAC9);
    bench.write(0x6003, 0, 0).unwrap();
    assert_eq!(bench.position(), 0);
    assert_eq!(bench.read(0x6509, 0), 0x1000_0000 - 0x3_CAC9);
    bench.write(0x6200, 0, 5).unwrap();
    assert_eq!(bench.read(0x1800, 5), 5);
    assert!(core::mem::take(&mut bench.signals.reconfigure));
    // 1011h takes the values back, then says so.
    bench.with(|encoder, cx| {
        cx.store.reset(|entry| entry.address.index >= 0x6000);
        encoder.reset(cx, Reset::Defaults);
    });
    assert_eq!(bench.position(), 0x7_9592);
    assert_eq!(bench.read(0x1800, 5), 0x203);
    assert!(bench.signals.reconfigure);
}

#[test]
fn a_new_resolution_clears_the_offset_unless_an_option_keeps_it() {
    let mut bench = Bench::new(0x2000_0000);
    bench.at(1000);
    bench.write(0x6003, 0, 5).unwrap();
    assert_eq!(bench.position(), 5);
    bench.write(0x6001, 0, 0x2000).unwrap();
    assert_eq!((bench.position(), bench.read(0x6509, 0)), (1000, 0));
    bench.write(0x6003, 0, 5).unwrap();
    bench.write(0x2110, 0, 0x208).unwrap();
    bench.write(0x6002, 0, 0x1000_0000).unwrap();
    assert_eq!(bench.read(0x6509, 0), 0x2000_0000 - 995);
    assert_eq!(bench.position(), 5, "modulo the new range");
}

#[test]
fn sense_and_scaling_keep_the_offset() {
    let mut bench = Bench::new(0x2000_0000);
    bench.at(1000);
    bench.write(0x6003, 0, 5).unwrap();
    let offset = bench.read(0x6509, 0);
    bench.write(0x6000, 0, 5).unwrap();
    assert_eq!(bench.read(0x6500, 0), 5);
    assert_eq!(bench.read(0x6509, 0), offset);
    assert_eq!(
        bench.position(),
        (0x2000_0000 - 1000 + offset) % 0x2000_0000
    );
    bench.write(0x6000, 0, 0xFFFE).unwrap();
    assert_eq!(bench.read(0x6500, 0), 4, "what there is");
    bench.write(0x6001, 0, 1000).unwrap();
    bench.at(0x1000);
    assert_eq!(bench.position(), 500);
    bench.write(0x6000, 0, 0).unwrap();
    assert_eq!(bench.position(), 0x1000);
}

#[test]
fn limits() {
    use AbortCode::{ValueRange, ValueTooHigh};
    let mut bench = Bench::new(0x2000_0000);
    for (index, sub, value, expected) in [
        (0x6001, 0, 0, Err(ValueRange)),
        (0x6001, 0, 0x2000, Ok(())),
        (0x6001, 0, 0x2001, Err(ValueTooHigh)),
        (0x6002, 0, 0, Err(ValueRange)),
        (0x6002, 0, 0x2000_0000, Ok(())),
        (0x6002, 0, 0x2000_0001, Err(ValueTooHigh)),
        (0x6002, 0, 1000, Ok(())),
        (0x6003, 0, 999, Ok(())),
        (0x6003, 0, 1000, Err(ValueTooHigh)),
        (0x2101, 0, 0, Err(ValueRange)),
        (0x2101, 0, 127, Ok(())),
        (0x2101, 0, 128, Err(ValueTooHigh)),
        (0x2100, 0, 8, Ok(())),
        (0x2100, 0, 9, Err(ValueRange)),
        (0x1029, 1, 3, Ok(())),
        (0x1029, 1, 4, Err(ValueRange)),
        (0x2110, 0, 0x28, Ok(())),
        (0x6000, 0, 0xFFFF, Ok(())),
    ] {
        assert_eq!(
            bench.write(index, sub, value),
            expected,
            "{index:X} {value:#X}"
        );
    }
}

#[test]
fn two_timers_are_one() {
    let mut bench = Bench::new(0x2000_0000);
    bench.write(0x1800, 5, 40).unwrap();
    assert_eq!(bench.read(0x6200, 0), 40);
    bench.write(0x2110, 0, 0x108).unwrap();
    assert_eq!((bench.read(0x6200, 0), bench.read(0x1800, 5)), (40, 42));
    bench.write(0x6200, 0, 10).unwrap();
    assert_eq!(bench.read(0x1800, 5), 12);
    bench.write(0x1800, 5, 7).unwrap();
    assert_eq!(bench.read(0x6200, 0), 5);
    bench.write(0x6200, 0, 0).unwrap();
    assert_eq!(bench.read(0x1800, 5), 0, "off is off");
    bench.write(0x6200, 0, 0xFFFF).unwrap();
    assert_eq!(bench.read(0x1800, 5), 0xFFFF);
    bench.write(0x2110, 0, 8).unwrap();
    // What a reset takes back is what the other follows.
    bench.write(0x6200, 0, 9).unwrap();
    bench.with(|encoder, cx| {
        cx.store.reset(|entry| entry.address.index < 0x2000);
        encoder.reset(cx, Reset::Communication);
    });
    assert_eq!(
        (bench.read(0x6200, 0), bench.read(0x1800, 5)),
        (0x203, 0x203)
    );
    // And at a start what storage held: here 6200h alone was saved.
    bench.with(|encoder, cx| {
        cx.store.reset(|_| true);
        cx.store.set_unsigned(Address::new(0x6200, 0), 11);
        encoder.reset(cx, Reset::Node);
    });
    assert_eq!((bench.read(0x6200, 0), bench.read(0x1800, 5)), (11, 11));
}

#[test]
fn switches_rule_the_node_id_and_the_bit_rate() {
    let mut bench = Bench::new(0x2000_0000);
    bench.write(0x2101, 0, 7).unwrap();
    let id = |bench: &mut Bench| bench.with(|encoder, cx| encoder.node_id(cx.store).unwrap().raw());
    assert_eq!((id(&mut bench), bench.encoder.bit_rate()), (7, Some(50)));
    bench.encoder.set_switches(Switches {
        node_id: 42,
        bit_rate: 3,
    });
    assert_eq!((id(&mut bench), bench.encoder.bit_rate()), (42, Some(50)));
    bench.reset(Reset::Node);
    assert_eq!(bench.encoder.bit_rate(), Some(125));
    assert_eq!(bench.read(0x2100, 0), 2, "as it is stored");
}

#[test]
fn faults_raise_errors_with_alarms_and_warnings_and_are_counted() {
    let mut bench = Bench::new(0x2000_0000);
    bench.encoder.set_fault(Fault::Position, true);
    bench.encoder.set_fault(Fault::Battery, true);
    bench.encoder.set_fault(Fault::Watchdog, true);
    bench.with(|encoder, cx| encoder.tick(cx));
    let error = |code, register, info| {
        ErrorChange::Raised(crate::Error {
            code,
            register,
            info,
        })
    };
    let position = error(0x7320, 0x81, [1, 0, 0, 0, 0]);
    let battery = error(0xFF00, 0x81, [1, 0, 0x10, 0, 0]);
    assert_eq!(bench.errors(), [position, battery]);
    bench.with(|encoder, cx| encoder.tick(cx));
    assert_eq!(bench.errors(), [], "once");
    assert_eq!((bench.read(0x6503, 0), bench.read(0x6505, 0)), (1, 0x10));
    bench.encoder.set_fault(Fault::Position, false);
    bench.with(|encoder, cx| encoder.tick(cx));
    let cleared = ErrorChange::Cleared {
        code: 0x7320,
        register: Some(0x81),
        info: [0, 0, 0x10, 0, 0],
    };
    assert_eq!(bench.errors(), [cleared]);
    bench.reset(Reset::Node);
    let watchdog = error(0x6010, 0x01, [0, 0, 0x14, 0, 0]);
    assert_eq!(
        bench.errors(),
        [error(0xFF00, 0x81, [0, 0, 0x10, 0, 0]), watchdog]
    );
    bench.reset(Reset::PowerOn);
    assert_eq!(
        bench.read(0x6505, 0),
        0x10,
        "the watchdog did not bite again"
    );
    assert_eq!(
        (bench.read(0x2201, 1), bench.read(0x2201, 3)),
        (1, 1),
        "kept without power"
    );

    let mut singleturn = Bench::new(0x2000);
    singleturn.encoder.set_fault(Fault::Battery, true);
    singleturn.with(|encoder, cx| encoder.tick(cx));
    assert_eq!(singleturn.errors(), [], "it has no battery");
}

#[test]
fn the_shaft_turns_without_power() {
    let mut bench = Bench::new(0x2000_0000);
    bench.at(100);
    bench.now = Instant::from_millis(1000);
    bench.encoder.power_off(bench.now);
    bench
        .encoder
        .shaft
        .turn(bench.now, Angle::from_fractions(3 << 32));
    bench.now = Instant::from_millis(5000);
    bench.reset(Reset::PowerOn);
    assert_eq!(bench.position(), 100 + 3 * 0x2000);
    // Three revolutions of 1000 steps; the counter passes its end without power.
    bench.write(0x6001, 0, 1000).unwrap();
    bench.write(0x6002, 0, 3000).unwrap();
    bench.encoder.set_raw_position(bench.now, 65_535 * 0x2000);
    assert_eq!(bench.position(), 0);
    let one = Angle::from_fractions(1 << 32);
    bench.encoder.shaft.turn(bench.now, one);
    assert_eq!(bench.position(), 1000, "with power it goes on");
    bench.encoder.shaft.turn(bench.now, Angle::ZERO.minus(one));
    bench.encoder.power_off(bench.now);
    bench.encoder.shaft.turn(bench.now, one);
    bench.with(|encoder, cx| encoder.reset(cx, Reset::PowerOn));
    assert_eq!(
        bench.position(),
        0,
        "it says what revolution 0 says, not 1000"
    );
    bench.encoder.shaft.turn(bench.now, one);
    assert_eq!(bench.position(), 1000);
}

#[test]
fn time_of_operation_is_without_the_time_off() {
    let mut bench = Bench::new(0x2000_0000);
    bench.now = Instant::from_millis(800_000);
    assert_eq!((bench.read(0x2201, 2), bench.read(0x6508, 0)), (800, 2));
    let next = bench.with(|encoder, cx| encoder.tick(cx));
    assert_eq!(next, Some(Instant::from_millis(1_080_000)));
    bench.encoder.power_off(bench.now);
    bench.now = Instant::from_millis(900_000);
    bench.reset(Reset::PowerOn);
    assert_eq!((bench.read(0x2201, 2), bench.read(0x6508, 0)), (800, 0));
    bench.now = Instant::from_millis(960_500);
    bench.reset(Reset::Node);
    assert_eq!((bench.read(0x2201, 2), bench.read(0x6508, 0)), (860, 0));
}

#[test]
fn a_dictionary_describes_its_sensor() {
    let sensor = |range| {
        let tables = tables(range);
        Encoder::for_dictionary(tables.dictionary())
            .unwrap()
            .sensor()
    };
    assert_eq!(
        sensor(0x2000_0000),
        Sensor {
            steps: 0x2000,
            turns: 0x1_0000
        }
    );
    assert_eq!(
        sensor(0x2000),
        Sensor {
            steps: 0x2000,
            turns: 1
        }
    );
    let mut encoder = Encoder::new(&PROFILE).with_serial_number(4711);
    let mut bench = Bench::new(0x2000);
    core::mem::swap(&mut bench.encoder, &mut encoder);
    bench.reset(Reset::PowerOn);
    assert_eq!((bench.read(0x1018, 4), bench.read(0x650B, 0)), (4711, 4711));
}
