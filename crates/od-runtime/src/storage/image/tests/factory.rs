//! A family that loads the factory values after an interrupted save (manual 001, chapter 6.3.3;
//! manual 003, chapter 5.1.3.1; MANUALS.md U-33).

use super::*;
use crate::profile::{CutSave, SavedCobIds, StoreProfile};
use od_model::Address;

const FACTORY: &StoreProfile = &StoreProfile {
    cut: CutSave::Factory,
    ..Profile::CIA301.store
};

const MOVING: &StoreProfile = &StoreProfile {
    cob_ids: SavedCobIds::Difference,
    ..*FACTORY
};

/// The defaults, and an operating record with this value.
fn factory(bench: &mut Bench, record: u64) -> Vec<String> {
    let mut store = bench.store();
    store.reset(|_| true);
    store.set_unsigned(Address::new(0x2201, 0), record);
    bench.values()
}

/// Executes the first part of a save.
fn begin_save(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    banks: &mut Banks,
) -> Result<(), StorageError> {
    let device = super::super::device(store.dictionary());
    let mut medium = Medium::new(storage, banks);
    medium.survey(device)?;
    medium.begin(store, FACTORY, &Plan::Save(1))
}

#[test]
fn power_can_fail_at_any_byte_and_leaves_the_factory_values() {
    for (saves, sub) in [(0u8, 1), (1, 1), (2, 1), (3, 1), (3, 3)] {
        for cut in 0.. {
            let (mut bench, mut memory) = (Bench::new(device()), storage());
            for with in 0..saves {
                bench.fill(7 + with);
                save(&mut memory, &bench.store(), FACTORY, 1).unwrap();
            }
            bench.start(&mut memory);
            let before = bench.values();
            let record = bench.store().unsigned(0x2201, 0);
            let blank = factory(&mut bench, record);
            bench.start(&mut memory);
            bench.fill(200);
            memory.cut_after(cut);
            let result = save(&mut memory, &bench.store(), FACTORY, sub);
            memory.restore_power();
            let loaded = bench.start(&mut memory);
            if result.is_ok() {
                assert!(cut > 50, "the save wrote something");
                assert_eq!(loaded, Loaded::Complete);
                assert_eq!(bench.store().unsigned(0x6003, 0), 200);
                let other = if sub == 1 { 200 } else { 9 };
                assert_eq!(bench.store().unsigned(0x1017, 0), other);
                break;
            }
            assert_eq!(result, Err(StorageError::PowerCut));
            match loaded {
                Loaded::Blank => assert_eq!((saves, bench.values()), (0, before)),
                Loaded::Cut { factory: true } => assert_eq!(bench.values(), blank, "cut at {cut}"),
                // Before the first byte, and after the last byte of the new set.
                Loaded::Complete if cut == 0 => assert_eq!(bench.values(), before),
                Loaded::Complete => assert_eq!(bench.store().unsigned(0x6003, 0), 200),
                other => panic!("{other:?}"),
            }
            if saves == 0 || loaded != (Loaded::Cut { factory: true }) {
                continue;
            }
            // The next saves do not bring the earlier values back.
            let record = bench.store();
            save(&mut memory, &record, FACTORY, 0).unwrap();
            assert_eq!(bench.start(&mut memory), Loaded::Complete);
            assert_eq!(bench.values(), blank);
            bench.fill(99);
            save(&mut memory, &bench.store(), FACTORY, 4).unwrap();
            assert_eq!(bench.start(&mut memory), Loaded::Complete);
            assert_eq!(bench.store().unsigned(0x2101, 0), 99);
            assert_eq!(bench.store().unsigned(0x6003, 0), 0);
        }
    }
}

#[test]
fn only_an_interrupted_save_of_a_master_removes_values() {
    for cut in 0.. {
        let (mut bench, mut memory) = (Bench::new(device()), storage());
        bench.fill(5);
        save(&mut memory, &bench.store(), FACTORY, 1).unwrap();
        memory.cut_after(cut);
        let record = save(&mut memory, &bench.store(), FACTORY, 0);
        memory.restore_power();
        let whole = if cut > 0 && record.is_err() {
            Loaded::Cut { factory: false }
        } else {
            Loaded::Complete
        };
        assert_eq!(bench.start(&mut memory), whole, "cut at {cut}");
        assert_eq!(bench.store().unsigned(0x6003, 0), 5);
        if record.is_ok() {
            break;
        }
    }
}

#[test]
fn values_removed_by_an_interrupted_save_stay_removed_if_the_next_set_is_damaged() {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    bench.fill(5);
    save(&mut memory, &bench.store(), FACTORY, 1).unwrap();
    let mut banks = Banks::NONE;
    begin_save(&mut memory, &bench.store(), &mut banks).unwrap();
    assert_eq!(bench.start(&mut memory), Loaded::Cut { factory: true });
    bench.fill(6);
    save(&mut memory, &bench.store(), FACTORY, 1).unwrap();
    assert_eq!(bench.start(&mut memory), Loaded::Complete);
    let newest = memory.bytes().len() / 2;
    memory.bytes_mut()[newest + HEADER] ^= 1;
    assert_eq!(bench.start(&mut memory), Loaded::Damaged);
    assert_eq!(bench.store().unsigned(0x6003, 0), 0);
}

#[test]
fn a_save_is_valid_only_after_its_end() {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    bench.fill(5);
    save(&mut memory, &bench.store(), FACTORY, 1).unwrap();
    bench.fill(6);
    let mut banks = Banks::NONE;
    begin_save(&mut memory, &bench.store(), &mut banks).unwrap();
    assert_eq!(bench.start(&mut memory), Loaded::Cut { factory: true });
    assert_eq!(bench.store().unsigned(0x6003, 0), 0);
    Medium::new(&mut memory, &mut banks).commit().unwrap();
    assert_eq!(bench.start(&mut memory), Loaded::Complete);
    assert_eq!(bench.store().unsigned(0x6003, 0), 6);
}

#[test]
fn a_cob_id_of_a_user_follows_the_node_id() {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    bench
        .store()
        .set_unsigned(Address::new(0x1014, 0), 0x8000_0087);
    save(&mut memory, &bench.store(), MOVING, 1).unwrap();
    for (node_id, cob_id) in [(1, 0x8000_0087), (3, 0x8000_0089), (127, 0x8000_0105)] {
        bench.node_id = node_id;
        let mut store = bench.store();
        store.reset(|_| true);
        let loaded = load(&mut memory, &mut store, MOVING, &|_| true);
        assert_eq!(loaded, Ok(Loaded::Complete));
        assert_eq!(bench.store().unsigned(0x1014, 0), cob_id);
    }
}

/// Memory whose write number `fails` does not succeed; later writes succeed.
struct Flaky {
    memory: Memory<Vec<u8>>,
    fails: usize,
}

impl Storage for Flaky {
    fn capacity(&self) -> usize {
        self.memory.capacity()
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.memory.read(offset, to)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        let fails = self.fails == 0;
        self.fails = self.fails.wrapping_sub(1);
        if fails {
            return Err(StorageError::Device);
        }
        self.memory.write(offset, bytes)
    }
}

#[test]
fn a_failed_save_with_power_on_leaves_the_set_before_it() {
    for fails in 0.. {
        let (mut bench, mut memory) = (Bench::new(device()), storage());
        bench.fill(5);
        save(&mut memory, &bench.store(), FACTORY, 1).unwrap();
        let before = bench.values();
        bench.fill(200);
        let mut flaky = Flaky { memory, fails };
        let mut banks = Banks::NONE;
        let result = begin_save(&mut flaky, &bench.store(), &mut banks);
        if result.is_ok() {
            assert!(fails > 3, "mark, magic, records and header were written");
            break;
        }
        assert_eq!(result.err(), Some(StorageError::Device));
        assert_eq!(bench.start(&mut flaky), Loaded::Complete, "write {fails}");
        assert_eq!(bench.values(), before, "write {fails}");
    }
}
