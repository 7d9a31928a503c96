//! The encoder behind a dictionary, without a node.

mod family;
mod faults;
mod objects;
mod world;

use std::vec;
use std::vec::Vec;

use od_eds::patch;
use od_eds::patch::{Edit, Raw, Target};
use od_eds::{Description, Tables};
use od_model::{Access, Address, DataType, ObjectCode};

use super::*;
use crate::application::{Application, Context, Reset, Signals};
use crate::emcy::Change;
use crate::store::Store;
use od_wire::{AbortCode, Instant, NodeId};

/// A family like that of the bus covers.
static PROFILE: EncoderProfile = EncoderProfile {
    total: Total::Steps,
    signed_offset: false,
    below_limit: AbortCode::ValueRange,
    objects: &[
        (Address::new(0x1029, 1), Role::OneOf(&[0, 1, 2, 3])),
        (Address::new(0x2100, 0), Role::BitRate),
        (Address::new(0x2101, 0), Role::NodeId),
        (Address::new(0x2201, 2), Role::Seconds),
        (Address::new(0x6508, 0), Role::TenthHoursSinceStart),
    ],
    options: Some(OptionObject {
        index: 0x2110,
        keep_offset: 1 << 9,
        delay_timer: 1 << 8,
        delay_ms: 2,
        ..OptionObject::NONE
    }),
    bit_rates: &[10, 20, 50, 100, 125, 250, 500, 800, 1000],
    switch_rates: &[10, 20, 50, 125, 250, 500, 800, 1000],
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

/// Shaft at rest at the angle that a test sets.
struct Still(Angle);

impl Motion for Still {
    fn angle(&mut self, _: Instant) -> Result<Angle, Fault> {
        Ok(self.0)
    }

    fn speed(&self, _: Instant, _: u32, _: Gain) -> Option<i64> {
        None
    }

    fn acceleration(&self, _: Instant, _: u32, _: Gain) -> Option<i64> {
        None
    }
}

struct Bench {
    tables: Tables,
    values: Vec<u8>,
    encoder: Encoder<Still>,
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
            encoder: Encoder::new(&PROFILE, Still(Angle::ZERO)),
            now: Instant::ZERO,
            signals: Signals::default(),
        };
        bench.reset(Reset::PowerOn);
        bench
    }

    fn with<R>(&mut self, call: impl FnOnce(&mut Encoder<Still>, &mut Context<'_, '_>) -> R) -> R {
        let dictionary = self.tables.dictionary();
        let mut store = Store::new(&dictionary, &mut self.values, NodeId::ONE).unwrap();
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
        self.encoder.shaft.0 = self.encoder.sensor().angle(raw);
    }

    fn errors(&mut self) -> Vec<Change> {
        core::iter::from_fn(|| self.signals.errors.pop()).collect()
    }
}
