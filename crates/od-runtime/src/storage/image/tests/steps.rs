//! A save in steps has the bytes of a save at once, and each step does little work.

use super::*;
use crate::profile::{CutSave, SavedCobIds};
use crate::storage::Save;

/// A storage that counts calls and bytes.
struct Counts {
    memory: Memory<Vec<u8>>,
    calls: usize,
    bytes: usize,
}

impl Storage for Counts {
    fn capacity(&self) -> usize {
        self.memory.capacity()
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        self.calls += 1;
        self.bytes += to.len();
        self.memory.read(offset, to)
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        self.calls += 1;
        self.bytes += bytes.len();
        self.memory.write(offset, bytes)
    }
}

/// Greatest number of calls and bytes of a step: 64 bytes, which are read back, and some headers
/// and codes.
const CALLS: usize = 24;
const BYTES: usize = 256;

/// Makes the next set in steps. Returns the result, the bytes, and the number of steps.
fn in_steps(
    bytes: Vec<u8>,
    bench: &mut Bench,
    profile: &StoreProfile,
    (restores, sub): (bool, u8),
) -> (Result<(), StorageError>, Vec<u8>, usize) {
    let mut storage = Counts {
        memory: Memory::new(bytes),
        calls: 0,
        bytes: 0,
    };
    let Bench {
        tables,
        values: own,
        node_id,
    } = bench;
    let dictionary = &tables.dictionary();
    let store = Store::new(dictionary, own, NodeId::new(*node_id).unwrap()).unwrap();
    let mut values = vec![0; dictionary.store_len()];
    let mut job = Job::new(
        &Save {
            restores,
            sub,
            device: crate::storage::image::device(dictionary),
            store: &store,
            profile,
        },
        &mut values,
    );
    // Changes during the save are not saved.
    let now = own.clone();
    own.fill(0xA5);
    let mut steps = 0;
    let result = loop {
        (storage.calls, storage.bytes, steps) = (0, 0, steps + 1);
        let result = job.step(&mut storage, dictionary, &mut values);
        assert!(storage.calls <= CALLS, "{} calls in a step", storage.calls);
        assert!(storage.bytes <= BYTES, "{} bytes in a step", storage.bytes);
        if let Some(result) = result {
            break result;
        }
    };
    *own = now;
    let found = newest(&mut storage).unwrap().unwrap_or(0..0);
    assert_eq!(job.newest(), found);
    (result, storage.memory.bytes().to_vec(), steps)
}

/// A device whose dictionary lacks some objects of others, with a string longer than a step.
fn variant(lacks: u16) -> Bench {
    let long: String = "long ".repeat(60);
    let mut rows = rows();
    rows.push((0x2301, DataType::VisibleString, Access::Rw, Raw::Text(long)));
    let number = |i: u16| (0x6100 + i, DataType::Unsigned8, Access::Rw, Raw::Integer(0));
    rows.extend((0..30).map(number));
    rows.retain(|row| row.0 == 0x1000 || (row.0 ^ row.0 >> 4) & 7 != lacks);
    Bench::new(tables(&rows))
}

#[test]
fn a_save_in_steps_leaves_the_bytes_of_one_made_at_once() {
    let mut seed = 0x2545_F491_4F6C_DD1D_u64;
    let mut below = |end: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 20) as usize % end
    };
    let mut benches: Vec<_> = [8, 1, 3, 7].map(variant).into();
    let mut outcomes = [0; 4];
    for round in 0..60 {
        let capacity = [40, 400, 700, 1000, 1600, 4000][below(6)];
        let mut bytes = vec![[0xFF, 0][below(2)]; capacity];
        for _ in 0..12 {
            let bench = &mut benches[below(4)];
            if below(3) == 0 {
                // With another node ID, which COB-IDs follow.
                bench.node_id = 1 + below(4) as u8;
                bench.store().reset(|_| true);
            }
            if below(3) > 0 {
                let value = below(256) as u64;
                for index in [0x1014, 0x1017, 0x2101, 0x2201, 0x6003, 0x6010] {
                    if below(3) > 0 {
                        let address = od_model::Address::new(index, 0);
                        bench.store().set_unsigned(address, value);
                    }
                }
            }
            let profile = StoreProfile {
                cut: [CutSave::LastSet, CutSave::Factory][below(2)],
                cob_ids: [SavedCobIds::Absolute, SavedCobIds::Difference][below(2)],
                ..*STORE
            };
            let command = (below(4) == 0, below(5) as u8);
            let mut memory = Memory::new(bytes.clone());
            let store = bench.store();
            let at_once = match command {
                (true, sub) => erase(&mut memory, &store, &profile, sub),
                (false, sub) => save(&mut memory, &store, &profile, sub),
            };
            let (result, made, steps) = in_steps(bytes, bench, &profile, command);
            assert_eq!(result, at_once, "{round}: {command:?}");
            assert_eq!(made, memory.bytes(), "{round}: {command:?}, {result:?}");
            outcomes[match result {
                Ok(()) if steps > 40 => 0,
                Ok(()) => 1,
                Err(StorageError::Full) => 2,
                Err(_) => 3,
            }] += 1;
            bytes = made;
            // Power fails, or a bit flips.
            if below(4) == 0 {
                let mut cut = Memory::new(bytes);
                cut.cut_after(below(300));
                let _ = save(&mut cut, &bench.store(), &profile, 1);
                bytes = cut.bytes().to_vec();
            }
            if below(8) == 0 {
                let place = below(bytes.len());
                bytes[place] ^= 1 << below(8);
            }
        }
    }
    assert!(
        outcomes[..3].iter().all(|times| *times > 20),
        "{outcomes:?}"
    );
}
