//! Tests of the bytes that a save leaves, also after power failures and damage.

use std::format;
use std::string::String;
use std::vec;
use std::vec::Vec;

use od_eds::patch;
use od_eds::patch::{Edit, Raw, Target};
use od_eds::{Description, Tables};
use od_model::{Access, DataType};

use super::*;
use crate::storage::Memory;

mod factory;
mod flips;
mod steps;
mod versions;
use crate::profile::Profile;
use od_wire::NodeId;

/// Bytes of a header in an EEPROM.
const HEADER: usize = layout::header(1);

const STORE: &StoreProfile = &Profile::CIA301.store;

/// Index, type, access, default.
type Row = (u16, DataType, Access, Raw);

fn tables(rows: &[Row]) -> Tables {
    let mut description = Description::default();
    for (index, data_type, access, default) in rows {
        let mut edit = Edit::add(Target::object(*index))
            .name(&format!("{index:04X}"))
            .data_type(*data_type)
            .access(*access);
        edit = edit.default(default.clone());
        if *index == 0x2201 {
            edit = edit.save(od_model::Group::Manufacturer);
        }
        let findings = patch::apply(&mut description, &[edit]);
        assert!(findings.is_empty(), "{findings:?}");
    }
    Tables::new(&description)
}

fn rows() -> Vec<Row> {
    use Access::{Ro, Rw};
    use DataType::{Integer16, Unsigned8, Unsigned32, VisibleString};
    vec![
        (0x1000, Unsigned32, Ro, Raw::Integer(0x0002_0196)),
        (0x1014, Unsigned32, Rw, Raw::NodeId(0x80)),
        (0x1017, Unsigned32, Rw, Raw::Integer(0)),
        (0x2101, Unsigned8, Rw, Raw::Integer(1)),
        (0x2201, Unsigned32, Ro, Raw::Integer(0)),
        (0x2300, VisibleString, Rw, Raw::Text("".into())),
        (0x6003, Unsigned32, Rw, Raw::Integer(0)),
        (0x6010, Integer16, Rw, Raw::Integer(-1)),
    ]
}

fn device() -> Tables {
    tables(&rows())
}

/// A store with defaults, overlaid with what is saved.
struct Bench {
    tables: Tables,
    values: Vec<u8>,
    node_id: u8,
}

impl Bench {
    fn new(tables: Tables) -> Self {
        let values = vec![0; tables.dictionary().store_len()];
        let mut bench = Self {
            tables,
            values,
            node_id: 1,
        };
        bench.store().reset(|_| true);
        bench
    }

    fn store(&mut self) -> Store<'_> {
        let node_id = NodeId::new(self.node_id).unwrap();
        let dictionary = std::boxed::Box::leak(std::boxed::Box::new(self.tables.dictionary()));
        Store::new(dictionary, &mut self.values, node_id).unwrap()
    }

    fn start(&mut self, storage: &mut dyn Storage) -> Loaded {
        let mut store = self.store();
        store.reset(|_| true);
        load(storage, &mut store, STORE, &|_| true).unwrap()
    }

    /// Every value as text.
    fn values(&mut self) -> Vec<String> {
        let store = self.store();
        let show = |entry: od_model::Entry| {
            let mut number = [0; 8];
            format!(
                "{} {:02X?}",
                entry.address,
                store.bytes(&entry, &mut number)
            )
        };
        store.dictionary().entries().map(show).collect()
    }

    /// Writes values by which sets can be told apart.
    fn fill(&mut self, with: u8) {
        let mut store = self.store();
        for index in [0x1017, 0x2101, 0x2201, 0x6003, 0x6010] {
            store.set_unsigned(od_model::Address::new(index, 0), u64::from(with));
        }
        let text = store.dictionary().entry(0x2300, 0).unwrap();
        store
            .put(&text, &vec![with; usize::from(with) % 30])
            .unwrap();
    }
}

fn storage() -> Memory<Vec<u8>> {
    let bytes = capacity_needed(&device().dictionary());
    Memory::new(vec![0xFF; bytes])
}

#[test]
fn saved_values_are_loaded() {
    // The bytes of a new EEPROM are all FFh, or all 0.
    for new in [0xFF, 0] {
        let mut bench = Bench::new(device());
        let mut memory = Memory::new(vec![new; capacity_needed(&device().dictionary())]);
        let defaults = bench.values();
        assert_eq!(bench.start(&mut memory), Loaded::Blank);
        assert_eq!(bench.values(), defaults);
        for with in 1..40 {
            bench.fill(with);
            let saved = bench.values();
            save(&mut memory, &bench.store(), STORE, 1).unwrap();
            assert_eq!(bench.start(&mut memory), Loaded::Complete, "{new:X}h");
            assert_eq!(bench.values(), saved);
        }
        erase(&mut memory, &bench.store(), STORE, 1).unwrap();
        assert_eq!(bench.start(&mut memory), Loaded::Complete);
        bench
            .store()
            .set_unsigned(od_model::Address::new(0x2201, 0), 0);
        assert_eq!(bench.values(), defaults, "all but the life record");
    }
}

#[test]
fn power_can_fail_at_any_byte() {
    for saves in 0..4u8 {
        for cut in 0.. {
            let (mut bench, mut memory) = (Bench::new(device()), storage());
            for with in 0..saves {
                bench.fill(7 + with);
                save(&mut memory, &bench.store(), STORE, 1).unwrap();
            }
            bench.start(&mut memory);
            let before = bench.values();
            bench.fill(200);
            let after = bench.values();
            memory.cut_after(cut);
            let result = save(&mut memory, &bench.store(), STORE, 1);
            memory.restore_power();
            let loaded = bench.start(&mut memory);
            if result.is_ok() {
                assert!(cut > 50, "the save wrote something");
                assert_eq!((loaded, bench.values()), (Loaded::Complete, after));
                break;
            }
            assert_eq!(result, Err(StorageError::PowerCut));
            let whole = match (cut, saves) {
                (0, 0) => Loaded::Blank,
                (0, _) => Loaded::Complete,
                _ => Loaded::Cut {
                    factory: saves == 0,
                },
            };
            assert_eq!((loaded, bench.values()), (whole, before), "cut at {cut}");
            // The next save works, too.
            bench.fill(99);
            let after = bench.values();
            save(&mut memory, &bench.store(), STORE, 1).unwrap();
            assert_eq!(bench.start(&mut memory), Loaded::Complete);
            assert_eq!(bench.values(), after);
        }
    }
}

#[test]
fn power_can_fail_while_a_group_is_restored() {
    for cut in 0.. {
        let (mut bench, mut memory) = (Bench::new(device()), storage());
        bench.fill(5);
        save(&mut memory, &bench.store(), STORE, 1).unwrap();
        let before = bench.values();
        memory.cut_after(cut);
        let result = erase(&mut memory, &bench.store(), STORE, 3);
        memory.restore_power();
        let loaded = bench.start(&mut memory);
        if cut > 0 && result.is_err() {
            assert_eq!(loaded, Loaded::Cut { factory: false });
        } else {
            assert_eq!(loaded, Loaded::Complete);
        }
        if result.is_ok() {
            assert_eq!(bench.store().unsigned(0x6003, 0), 0);
            assert_eq!(bench.store().unsigned(0x1017, 0), 5);
            break;
        }
        assert_eq!(bench.values(), before, "cut at {cut}");
    }
}

#[test]
fn garbage_is_damaged_and_can_be_overwritten_by_a_save() {
    let mut random = 0x1234_5678_9ABC_DEF0u64;
    let mut byte = move || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        random as u8
    };
    let mut bench = Bench::new(device());
    let defaults = bench.values();
    for round in 0..3000usize {
        let mut memory = storage();
        let len = memory.capacity() - round % 60;
        memory = Memory::new((0..len).map(|_| byte()).collect());
        if round % 2 == 0 {
            // Device, length and checksum are right, but nothing else.
            let room = len / 2 - HEADER;
            let device = super::device(&bench.tables.dictionary());
            let records = round % room;
            let bytes = memory.bytes_mut();
            bytes[0] = [0x0F, 0x33, 0x3C, 0x55, 0x5A][round % 5];
            bytes[2..6].copy_from_slice(&device.to_le_bytes());
            bytes[6..10].copy_from_slice(&(records as u32).to_le_bytes());
            let mut crc = super::super::crc::Crc32::new();
            crc.update(&bytes[2..10]);
            crc.update(&bytes[HEADER..HEADER + records]);
            bytes[10..14].copy_from_slice(&crc.finish().to_le_bytes());
        }
        let loaded = bench.start(&mut memory);
        // A byte may look like the mark of a save.
        if matches!(loaded, Loaded::Damaged | Loaded::Cut { factory: true }) {
            assert_eq!(bench.values(), defaults);
        } else {
            assert!(round % 2 == 0, "{round}: {loaded:?}");
        }
        if round % 60 == 0 {
            bench.fill(9);
            let saved = bench.values();
            save(&mut memory, &bench.store(), STORE, 1).unwrap();
            bench.start(&mut memory);
            assert_eq!(bench.values(), saved);
        }
    }
}

#[test]
fn a_group_is_saved_without_the_others() {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    bench.fill(5);
    save(&mut memory, &bench.store(), STORE, 2).unwrap();
    bench.fill(6);
    save(&mut memory, &bench.store(), STORE, 3).unwrap();
    bench.fill(7);
    bench.start(&mut memory);
    let mut store = bench.store();
    assert_eq!(store.unsigned(0x1017, 0), 5);
    assert_eq!(store.unsigned(0x6003, 0), 6);
    assert_eq!(store.unsigned(0x2101, 0), 1, "never saved");
    assert_eq!(
        store.unsigned(0x2201, 0),
        6,
        "the life record goes with every save"
    );
    store.set_unsigned(od_model::Address::new(0x2201, 0), 8);
    save(&mut memory, &store, STORE, 0).unwrap();
    bench.start(&mut memory);
    assert_eq!(bench.store().unsigned(0x2201, 0), 8, "and only it");
    assert_eq!(bench.store().unsigned(0x6003, 0), 6);
}

#[test]
fn a_node_id_default_follows_the_node_id() {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    save(&mut memory, &bench.store(), STORE, 1).unwrap();
    bench.node_id = 9;
    bench.start(&mut memory);
    assert_eq!(bench.store().unsigned(0x1014, 0), 0x89);
    bench
        .store()
        .set_unsigned(od_model::Address::new(0x1014, 0), 0x81);
    save(&mut memory, &bench.store(), STORE, 1).unwrap();
    bench.node_id = 2;
    bench.start(&mut memory);
    assert_eq!(
        bench.store().unsigned(0x1014, 0),
        0x81,
        "a value of the user's is absolute"
    );
}

#[test]
fn an_image_survives_another_dictionary() {
    use DataType::{Unsigned16, Unsigned32};
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    bench.fill(5);
    let saved = bench.values();
    save(&mut memory, &bench.store(), STORE, 1).unwrap();
    // 1017h is shorter, 2101h and 2300h are gone, 6003h stayed, 7000h is new.
    let mut other = Bench::new(tables(&[
        (0x1017, Unsigned16, Access::Rw, Raw::Integer(0)),
        (0x6003, Unsigned32, Access::Rw, Raw::Integer(0)),
        (0x7000, Unsigned32, Access::Rw, Raw::Integer(1)),
    ]));
    assert_eq!(other.start(&mut memory), Loaded::Partial { skipped: 5 });
    assert_eq!(other.store().unsigned(0x1017, 0), 0);
    assert_eq!(other.store().unsigned(0x6003, 0), 5);
    save(&mut memory, &other.store(), STORE, 3).unwrap();
    assert_eq!(bench.start(&mut memory), Loaded::Partial { skipped: 1 });
    assert_eq!(bench.values(), saved, "what it did not know, it kept");

    // Without room for both, the values that the device knows have priority.
    let mut small = Memory::new(memory.into_inner());
    let mut large = Bench::new(tables(&[
        (0x1017, Unsigned32, Access::Rw, Raw::Integer(3)),
        (
            0x5000,
            DataType::VisibleString,
            Access::Rw,
            Raw::Text("0123456789".repeat(7)),
        ),
    ]));
    save(&mut small, &large.store(), STORE, 1).unwrap();
    let before = large.values();
    assert_eq!(
        large.start(&mut small),
        Loaded::Complete,
        "the others are gone"
    );
    assert_eq!(large.values(), before);
}

#[test]
fn limits_hold_for_saved_values() {
    let limited = |high| {
        let mut description = Description::default();
        let edit = Edit::add(Target::object(0x6001))
            .name("Resolution")
            .data_type(DataType::Unsigned32)
            .access(Access::Rw)
            .default(Raw::Integer(1))
            .low(Raw::Integer(1))
            .high(Raw::Integer(high));
        assert!(patch::apply(&mut description, &[edit]).is_empty());
        Bench::new(Tables::new(&description))
    };
    let (mut bench, mut memory) = (limited(0x2000), storage());
    bench
        .store()
        .set_unsigned(od_model::Address::new(0x6001, 0), 0x2000);
    save(&mut memory, &bench.store(), STORE, 1).unwrap();
    assert_eq!(bench.start(&mut memory), Loaded::Complete);
    let mut bench = limited(0x1000);
    assert_eq!(bench.start(&mut memory), Loaded::Partial { skipped: 1 });
    assert_eq!(bench.store().unsigned(0x6001, 0), 1);
}
