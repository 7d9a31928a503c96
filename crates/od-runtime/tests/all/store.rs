//! Store and restore by group (CiA 301, objects 1010h and 1011h).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{NoApplication, Profile, Restore, StoreProfile};

/// Groups 1 to 4, with one value each: 1017h, 6000h, 2000h.
fn bench() -> Bench {
    let mut all = rows();
    for index in [0x1010, 0x1011] {
        for sub in 2..=4 {
            all.push((
                index,
                sub,
                DataType::Unsigned32,
                Access::Rw,
                false,
                unsigned(1),
            ));
        }
    }
    all.push((
        0x6000,
        0,
        DataType::Unsigned16,
        Access::Rw,
        false,
        unsigned(4),
    ));
    let mut bench = Bench::with(all, NoApplication);
    bench.power_on();
    bench
}

fn change(bench: &mut Bench, value: u8) {
    for request in ["2B1710", "230020", "2B0060"] {
        let answer = bench.ask(&format!("601#{request}00{value:02X}000000"));
        assert_eq!(&answer[4..6], "60", "{request}");
    }
}

fn values(bench: &Bench) -> [u64; 3] {
    [
        bench.value(0x1017, 0),
        bench.value(0x6000, 0),
        bench.value(0x2000, 0),
    ]
}

fn command(bench: &mut Bench, index: &str, sub: u8) {
    let signature = if index == "10" {
        "73617665"
    } else {
        "6C6F6164"
    };
    let answer = bench.ask(&format!("601#23{index}10{sub:02X}{signature}"));
    assert_eq!(&answer[4..6], "60");
}

fn cycle(bench: &mut Bench) {
    bench.node.power_off();
    bench.power_on();
}

#[test]
fn each_sub_index_saves_and_restores_its_group() {
    for (sub, kept) in [
        (1, [9, 9, 9]),
        (2, [9, 4, 5]),
        (3, [0, 9, 5]),
        (4, [0, 4, 9]),
    ] {
        let mut bench = bench();
        change(&mut bench, 9);
        command(&mut bench, "10", sub);
        cycle(&mut bench);
        assert_eq!(values(&bench), kept, "1010h:{sub:02X}");
        command(&mut bench, "10", 1);
        command(&mut bench, "11", sub);
        cycle(&mut bench);
        assert_eq!(values(&bench), [0, 4, 5], "1011h:{sub:02X}");
    }
}

#[test]
fn groups_are_saved_one_after_the_other() {
    let mut bench = bench();
    change(&mut bench, 9);
    command(&mut bench, "10", 2);
    change(&mut bench, 10);
    command(&mut bench, "10", 4);
    cycle(&mut bench);
    assert_eq!(values(&bench), [9, 4, 10]);
    command(&mut bench, "11", 4);
    cycle(&mut bench);
    assert_eq!(values(&bench), [9, 4, 5]);
}

#[test]
fn a_family_may_restore_at_once() {
    let mut bench = bench();
    let store = StoreProfile {
        restore: Restore::AtOnce,
        ..Profile::CIA301.store
    };
    bench.node.device_mut().profile = Profile {
        store,
        ..Profile::CIA301
    };
    change(&mut bench, 9);
    command(&mut bench, "10", 1);
    command(&mut bench, "11", 1);
    assert_eq!(values(&bench), [0, 4, 5]);
    assert!(
        bench.wait(100).is_empty(),
        "the heartbeat stopped with 1017h"
    );
    cycle(&mut bench);
    assert_eq!(values(&bench), [0, 4, 5]);
}

#[test]
fn a_cob_id_that_was_never_changed_follows_the_node_id() {
    let mut bench = bench();
    bench.ask("601#2314100099000080");
    bench.ask("601#2314100099000000");
    command(&mut bench, "10", 1);
    bench = bench.at(od_runtime::NodeId::new(9).expect("1–127"));
    cycle(&mut bench);
    assert_eq!(bench.value(0x1014, 0), 0x99, "changed and saved");
    assert_eq!(bench.value(0x1800, 1), 0x189, "still the default");
}

#[test]
fn a_storage_that_fails_reports_it_and_keeps_the_last_set() {
    let mut bench = bench();
    change(&mut bench, 9);
    command(&mut bench, "10", 1);
    change(&mut bench, 10);
    bench.node.storage.cut_after(20);
    assert_eq!(bench.ask("601#2310100173617665"), "581#8010100100000606");
    bench.node.storage.restore_power();
    cycle(&mut bench);
    assert_eq!(values(&bench), [9, 9, 9]);
}

#[test]
fn a_saved_value_that_the_object_cannot_have_is_left_out() {
    let mut bench = bench();
    change(&mut bench, 9);
    // 2006h is a BOOLEAN; a damaged device saves a 2.
    let slot = bench.entry(od_model::Address::new(0x2006, 0)).slot;
    bench.node.look(|_, store| {
        let bits = od_model::typed::Var::<u8, od_model::typed::Ro>::new(
            od_model::Address::new(0x2006, 0),
            slot,
            8,
        );
        store.set(bits, 2);
    });
    command(&mut bench, "10", 1);
    cycle(&mut bench);
    assert_eq!(bench.value(0x2006, 0), 0);
    assert_eq!(values(&bench), [9, 9, 9], "the rest is loaded");
}

#[test]
fn a_number_is_written_in_its_own_length() {
    use od_model::Address;
    use od_runtime::{AbortCode, NodeId, Store};
    let bench = bench();
    let entry = bench.entry(Address::new(0x2000, 0));
    let dictionary = bench.node.device().tables.dictionary();
    let mut values = bench.node.values().to_vec();
    let mut store = Store::new(&dictionary, &mut values, NodeId::ONE).expect("room");
    for (bytes, result) in [
        (&[1, 2, 3, 4][..], Ok(())),
        (&[5, 6, 7], Err(AbortCode::TooShort)),
        (&[5, 6, 7, 8, 9], Err(AbortCode::TooLong)),
        (&[], Err(AbortCode::TooShort)),
    ] {
        assert_eq!(store.put(&entry, bytes), result, "{bytes:?}");
        assert_eq!(store.number(&entry), 0x0403_0201);
        assert!(!store.is_default(&entry));
    }
    store.reset_entry(&entry);
    assert!(store.is_default(&entry));
}

#[test]
fn a_handle_of_a_constant_has_its_default() {
    use od_model::typed::Var;
    use od_model::{Address, Slot};
    let bench = bench();
    let dictionary = bench.node.device().tables.dictionary();
    let mut values = bench.node.values().to_vec();
    let store = od_runtime::Store::new(&dictionary, &mut values, od_runtime::NodeId::ONE);
    let store = store.expect("room");
    let handle = |index| {
        let nowhere = Slot { offset: 0, len: 0 };
        Var::<u8, ()>::new(Address::new(index, 0), nowhere, 8)
    };
    assert_eq!(store.get(handle(0x1010)), 1);
    assert_eq!(store.get(handle(0x2FFF)), 0, "there is no such object");
}
