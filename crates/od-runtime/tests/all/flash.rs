//! The saved values on NOR flash: whole words, each written once after an erasure, and a power
//! failure in any step.

use crate::nor::Nor;
use crate::support::{rows, tables, unsigned};
use od_model::{Access, Address, DataType};
use od_runtime::rooms::{LoadedRooms, LoadedValues};
use od_runtime::storage::image::{self, Loaded};
use od_runtime::storage::{Storage, StorageError};
use od_runtime::{
    AbortCode, CutSave, Event, Frame, Instant, NoApplication, Node, NodeId, Profile, Store,
    StoreProfile,
};

/// Page and word.
const GEOMETRIES: [(usize, usize); 7] = [
    (512, 1),
    (512, 2),
    (1024, 4),
    (64, 4),
    (2048, 8),
    (128, 16),
    (4096, 32),
];

/// A device whose values differ between sets.
struct Device {
    dictionary: &'static od_model::Dictionary<'static>,
    values: Vec<u8>,
    profile: StoreProfile,
}

impl Device {
    fn new(cut: CutSave) -> Self {
        let mut all = rows();
        all.retain(|row| row.0 != 0x2003 && !(0x1400..0x2000).contains(&row.0));
        all.push((
            0x2300,
            0,
            DataType::Unsigned32,
            Access::Rw,
            false,
            unsigned(0),
        ));
        let tables = Box::leak(Box::new(tables(all)));
        let dictionary = &*Box::leak(Box::new(tables.dictionary()));
        let values = vec![0; dictionary.store_len()];
        let profile = StoreProfile {
            cut,
            ..Profile::CIA301.store
        };
        let mut device = Self {
            dictionary,
            values,
            profile,
        };
        device.store().reset(|_| true);
        device
    }

    fn store(&mut self) -> Store<'_> {
        Store::new(self.dictionary, &mut self.values, NodeId::ONE).expect("room")
    }

    /// Flash of the size that the device needs.
    fn flash(&self, page: usize, word: usize) -> Nor {
        let capacity = image::capacity_on(self.dictionary, page, word);
        Nor::new(capacity, page, word)
    }

    fn fill(&mut self, with: u8) {
        let mut store = self.store();
        for index in [0x1017, 0x2000, 0x2001, 0x2300] {
            store.set_unsigned(Address::new(index, 0), u64::from(with) * 3);
        }
        let text = store.dictionary().entry(0x2002, 0).expect("a text");
        let longest = usize::from(text.slot.len) - 2;
        let text_of_it = vec![b'a' + with % 26; usize::from(with) % longest];
        store.put(&text, &text_of_it).expect("it fits");
    }

    fn save(&mut self, flash: &mut Nor) -> Result<(), StorageError> {
        let profile = self.profile;
        image::save(flash, &self.store(), &profile, 1)
    }

    /// Every value; the slot of a string may contain anything after its end.
    fn set(&mut self) -> Vec<Vec<u8>> {
        let store = self.store();
        let entries = store.dictionary().entries().iter();
        entries
            .map(|entry| store.bytes(&entry, &mut [0; 8]).to_vec())
            .collect()
    }

    fn start(&mut self, flash: &mut Nor) -> (Loaded, Vec<Vec<u8>>) {
        let profile = self.profile;
        let mut store = self.store();
        store.reset(|_| true);
        let loaded = image::load(flash, &mut store, &profile, &|_| true).expect("it can be read");
        (loaded, self.set())
    }
}

#[test]
fn saves_erase_one_page_of_a_bank_and_write_no_word_twice() {
    for (page, word) in GEOMETRIES {
        let mut device = Device::new(CutSave::LastSet);
        let mut flash = device.flash(page, word);
        let pages = flash.capacity() / 2 / page;
        assert_eq!(pages == 1, page > 256, "words of {word}");
        for with in 1..30 {
            device.fill(with);
            let before = flash.erases;
            device.save(&mut flash).expect("a save");
            assert!(flash.erases - before <= pages, "{page}, {word}");
            let values = device.set();
            assert_eq!(device.start(&mut flash), (Loaded::Complete, values));
        }
    }
}

#[test]
fn a_small_set_in_a_large_bank_needs_one_erasure() {
    let mut device = Device::new(CutSave::LastSet);
    let mut flash = Nor::new(32 * 1024, 1024, 8);
    for with in 1..10 {
        device.fill(with);
        device.save(&mut flash).expect("a save");
    }
    assert_eq!(flash.erases, 9);
}

#[test]
fn a_page_after_the_set_is_erased_only_if_needed() {
    let mut device = Device::new(CutSave::LastSet);
    let mut flash = Nor::new(8192, 1024, 1);
    device.save(&mut flash).expect("a save");
    let set = image::newest(&mut flash).expect("it can be read");
    let page = set.expect("a set").len();
    // The set fills the first of two pages.
    let mut flash = Nor::new(4 * page, page, 1);
    device.save(&mut flash).expect("a save");
    assert_eq!(flash.erases, 1);
    // The rest of a longer set is erased, too.
    flash.bytes[page..2 * page].fill(b'x');
    device.save(&mut flash).expect("in the other bank");
    device.save(&mut flash).expect("a save");
    assert!(flash.bytes[page..2 * page].iter().all(|byte| *byte == 0xFF));
    // Pages of zeros are erased, too, before a set is written there.
    flash.bytes.fill(0);
    device.save(&mut flash).expect("a save");
    let values = device.set();
    assert_eq!(device.start(&mut flash), (Loaded::Complete, values));
}

#[test]
fn power_can_fail_in_any_step() {
    for (cut, seeds) in [(CutSave::LastSet, 2), (CutSave::Factory, 2)] {
        for (page, word) in GEOMETRIES {
            for saves in 0..4u8 {
                let (mut steps, mut seed) = (0, 0);
                loop {
                    let mut device = Device::new(cut);
                    let defaults = device.set();
                    let mut flash = device.flash(page, word);
                    for with in 0..saves {
                        device.fill(7 + with);
                        device.save(&mut flash).expect("a save");
                    }
                    let before = device.start(&mut flash).1;
                    device.fill(200);
                    let after = device.set();
                    flash.cut_after(steps, seed);
                    let result = device.save(&mut flash);
                    flash.restore_power();
                    let place =
                        format!("{cut:?} {page}/{word}, {saves} saves, step {steps}.{seed}");
                    let (loaded, now) = device.start(&mut flash);
                    if result.is_ok() {
                        assert_eq!((loaded, now), (Loaded::Complete, after), "{place}");
                        assert!(steps > 3, "{place}");
                        break;
                    }
                    assert_eq!(result, Err(StorageError::PowerCut), "{place}");
                    let kept = match cut {
                        CutSave::LastSet => &before,
                        CutSave::Factory => &defaults,
                    };
                    // In its first step the save has hardly begun, and in its last it may be
                    // complete.
                    let is_kept = now == *kept || steps == 0 && now == before;
                    assert!(is_kept || now == after, "{place}: {loaded:?}");
                    let said = match loaded {
                        Loaded::Complete | Loaded::Flawed if now != after => &before,
                        Loaded::Complete | Loaded::Flawed => &after,
                        Loaded::Cut { factory: false } => &before,
                        Loaded::Cut { factory: true } | Loaded::Blank => &defaults,
                        Loaded::Damaged if saves == 0 && steps == 0 => &defaults,
                        other => panic!("{place}: {other:?}"),
                    };
                    assert_eq!(now, *said, "{place}: {loaded:?}");
                    // The next saves work, too.
                    for with in [99, 100] {
                        device.fill(with);
                        device.save(&mut flash).expect("a save");
                        let values = device.set();
                        assert_eq!(device.start(&mut flash).1, values, "{place}");
                    }
                    assert_eq!(device.start(&mut flash).0, Loaded::Complete, "{place}");
                    seed += 1;
                    if seed == seeds {
                        (steps, seed) = (steps + 1, 0);
                    }
                }
            }
        }
    }
}

#[test]
fn a_flipped_bit_is_noticed_in_words_of_any_length() {
    for (page, word) in [(512, 2), (1024, 8), (2048, 32)] {
        let mut device = Device::new(CutSave::LastSet);
        let mut flash = device.flash(page, word);
        let mut sets = vec![device.set()];
        for saves in 0..4 {
            if saves > 0 {
                device.fill(10 + saves);
                device.save(&mut flash).expect("a save");
                sets.push(device.set());
            }
            // Pages are larger than their content, so only the ends are tested.
            let len = flash.bytes.len();
            let ends = [(0, 300), (len / 2, 300), (len - 10, 10)];
            for at in ends.into_iter().flat_map(|(from, len)| from..from + len) {
                let mut flipped = flash.clone();
                flipped.bytes[at] ^= 1 << (at % 8);
                let newest = usize::from(saves);
                let (loaded, now) = device.start(&mut flipped);
                let said = match loaded {
                    Loaded::Flawed => newest,
                    Loaded::Older => newest - 1,
                    Loaded::Damaged => 0,
                    other => panic!("word {word}, byte {at}, {saves} saves: {other:?}"),
                };
                assert!(now == sets[said], "word {word}, byte {at}: {loaded:?}");
            }
        }
    }
}

#[test]
fn a_word_that_cannot_be_written_fails_the_save() {
    for cut in [CutSave::LastSet, CutSave::Factory] {
        let mut failed = 0;
        for stuck in (0..1024).step_by(8) {
            let mut device = Device::new(cut);
            let mut flash = device.flash(1024, 8);
            for with in 1..3 {
                device.fill(with);
                device.save(&mut flash).expect("a save");
            }
            let before = device.set();
            // The next save goes into the first bank.
            flash.stuck = Some(stuck);
            device.fill(9);
            let result = device.save(&mut flash);
            let after = device.set();
            let (loaded, now) = device.start(&mut flash);
            if result.is_ok() {
                assert_eq!((loaded, now), (Loaded::Complete, after), "{stuck}");
                continue;
            }
            failed += 1;
            assert_eq!(result, Err(StorageError::NotWritten));
            // A stuck commit word (at 0) shows neither that the save is complete nor that it failed.
            if stuck > 0 {
                assert_eq!((loaded, now), (Loaded::Complete, before), "{stuck}");
            }
        }
        assert!(failed > 10);
    }
}

/// The dictionary of [`Device`], as the device of a node.
struct Compiled(&'static od_model::Dictionary<'static>);

impl od_runtime::Services for Compiled {}

impl od_runtime::Device for Compiled {
    type Values = LoadedValues;
    type Rooms = LoadedRooms;

    fn dictionary(&self) -> od_model::Dictionary<'_> {
        *self.0
    }
}

/// A node of [`Compiled`]: it responds to the save and reports an event.
#[test]
fn a_save_that_is_not_in_the_memory_aborts_and_is_reported() {
    let device = Device::new(CutSave::LastSet);
    let flash = device.flash(1024, 8);
    let now = Instant::ZERO;
    let device = Compiled(device.dictionary);
    let mut node = Node::new(device, NodeId::ONE, NoApplication, flash);
    node.power_on(now);
    while node.poll_transmit(now).is_some() {}
    let save = Frame::standard(0x601, &[0x23, 0x10, 0x10, 1, b's', b'a', b'v', b'e']);
    let mut answers = Vec::new();
    for stuck in [None, Some(1024 + 16)] {
        node.storage.stuck = stuck;
        while node.poll_event().is_some() {}
        node.handle_frame(now, &save);
        let answer = node.poll_transmit(now).expect("an answer");
        let events: Vec<_> = std::iter::from_fn(|| node.poll_event()).collect();
        answers.push((answer.data()[0], answer.data()[4..].to_vec(), events));
    }
    let abort = AbortCode::Hardware.code().to_le_bytes().to_vec();
    assert_eq!(abort, [0, 0, 6, 6]);
    assert_eq!(answers[0], (0x60, vec![0; 4], vec![Event::Saved(1)]));
    assert_eq!(answers[1], (0x80, abort, vec![Event::NotSaved]));
}
