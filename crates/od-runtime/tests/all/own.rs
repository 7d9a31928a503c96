//! Changes that the device itself makes: a value, an error, the node ID that it was made with.

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, Address, DataType};
use od_runtime::storage::{Storage, StorageError};
use od_runtime::{AbortCode, Emcy, NodeId};

const WORKING: Address = Address::new(0x2000, 0);
const READ_ONLY: Address = Address::new(0x2010, 0);

fn bench() -> Bench {
    let mut all = rows();
    all.push((
        0x2010,
        0,
        DataType::Unsigned16,
        Access::Ro,
        true,
        unsigned(7),
    ));
    Bench::with(all, od_runtime::NoApplication)
}

macro_rules! own {
    ($bench:expr, $call:ident($($argument:expr),*)) => {
        $bench.node.$call($bench.now, $($argument),*)
    };
}

#[test]
fn a_save_of_the_device_itself_delays_no_client() {
    let mut bench = bench();
    bench.node.device_mut().profile.store.duration_us = 50_000;
    bench.power_on();
    bench.ask("601#2300200007000000");
    let save = Address::new(0x1010, 1);
    assert_eq!(own!(bench, set_value(save, b"save")), Ok(()));
    assert_eq!(
        own!(bench, set_value(save, b"load")),
        Err(AbortCode::NotStored)
    );
    assert_eq!(bench.ask("601#2300200008000000"), "581#6000200000000000");
    assert!(bench.wait(50).is_empty());
    bench.power_cycle();
    assert_eq!(bench.value(0x2000, 0), 7);
}

#[test]
fn the_device_sets_a_value_that_masters_can_only_read() {
    let mut bench = bench();
    bench.power_on();
    assert_eq!(own!(bench, set_value(READ_ONLY, &[0x34, 0x12])), Ok(()));
    assert_eq!(bench.ask("601#4010200000000000"), "581#4B10200034120000");
    assert_eq!(bench.ask("601#2B10200001000000"), "581#8010200002000106");
}

#[test]
fn values_set_by_the_device_obey_limits_and_length() {
    let mut bench = bench();
    bench.power_on();
    for (value, abort) in [
        (&[1, 0, 0, 0][..], AbortCode::ValueTooLow),
        (&[0, 0, 0, 1], AbortCode::ValueTooHigh),
        (&[5, 0], AbortCode::TooShort),
        (&[5, 0, 0, 0, 0], AbortCode::TooLong),
    ] {
        assert_eq!(own!(bench, set_value(WORKING, value)), Err(abort));
    }
    let unknown = Address::new(0x2FFF, 0);
    assert_eq!(
        own!(bench, set_value(unknown, &[0])),
        Err(AbortCode::NoObject)
    );
    assert_eq!(bench.ask("601#4000200000000000"), "581#4300200005000000");
}

#[test]
fn event_driven_tpdos_follow_a_value_that_the_device_sets() {
    let mut bench = bench();
    bench.power_on();
    bench.send("000#0100");
    assert_eq!(own!(bench, set_value(WORKING, &[9, 0, 0, 0])), Ok(()));
    assert_eq!(bench.change(), ["181#09000000", "281#09000000"]);
}

#[test]
fn an_error_is_raised_once_and_cleared_once() {
    let mut bench = bench();
    bench.power_on();
    let error = Emcy {
        code: 0x5530,
        register: 0x01,
        info: [1, 2, 3, 4, 5],
    };
    assert!(!own!(bench, clear(error)), "it has not come yet");
    assert!(own!(bench, raise(error)));
    assert_eq!(bench.change(), ["081#3055010102030405"]);
    assert!(!own!(bench, raise(error)), "it is there already");
    assert!(bench.change().is_empty());
    assert!(own!(bench, clear(error)));
    assert_eq!(bench.change(), ["081#0000000102030405"]);
    assert!(!own!(bench, clear(error)), "it has gone");
}

#[test]
fn without_power_nothing_is_set_or_raised() {
    let mut bench = bench();
    let error = Emcy {
        code: 0x5530,
        register: 0x01,
        info: [0; 5],
    };
    assert_eq!(
        own!(bench, set_value(WORKING, &[9, 0, 0, 0])),
        Err(AbortCode::DeviceState)
    );
    assert!(!own!(bench, raise(error)));
    assert_eq!(bench.power_on(), ["701#00"]);
    assert_eq!(bench.ask("601#4000200000000000"), "581#4300200005000000");
}

#[test]
fn a_new_node_id_of_the_device_applies_at_the_next_power_on() {
    let mut bench = bench();
    bench.node.set_node_id(None);
    assert!(
        !bench.node.is_configured(),
        "at once while it is without power"
    );
    bench.node.set_node_id(NodeId::new(9));
    assert!(bench.node.is_configured());
    bench.power_on();
    bench.node.set_node_id(None);
    assert!(bench.node.is_configured(), "it runs");
}

/// Pages that need an erasure, in a driver that does not implement it.
struct Unerasable;

impl Storage for Unerasable {
    fn capacity(&self) -> usize {
        64
    }

    fn read(&mut self, _: usize, _: &mut [u8]) -> Result<(), StorageError> {
        Ok(())
    }

    fn write(&mut self, _: usize, _: &[u8]) -> Result<(), StorageError> {
        Ok(())
    }
}

#[test]
fn a_storage_without_erasure_reports_it() {
    assert_eq!(Unerasable.erase(0), Err(StorageError::Device));
}
