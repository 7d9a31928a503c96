//! A save in steps, for storage that is written in the background.
//!
//! The image has the same bytes as that of [`save`](super::save) and [`erase`](super::erase).

use core::ops::Range;

use od_model::Dictionary;
use od_wire::NodeId;

use super::banks::{Bank, Banks};
use super::layout::{Code, ERASED, FIELDS, Layout, MAX_WORD};
use super::medium::{Content, Medium};
use super::merge::{Plan, Set, Source};
use super::walk::{STEP, Walk};
use crate::profile::StoreProfile;
use crate::storage::crc::Crc32;
use crate::storage::{Save, Storage, StorageError};
use crate::store::Store;

/// A save or a restore in bounded steps, with the values at the moment when it began.
///
/// It is for a storage that [takes over](Storage::take) the saves of the node. It writes the image
/// into memory that needs no erasure, such as RAM that is copied to flash later.
#[derive(Clone, Debug)]
pub struct Job {
    plan: Plan<'static>,
    profile: StoreProfile,
    node_id: NodeId,
    banks: Banks,
    phase: Phase,
    /// The first bank, while the second one is read.
    first: Option<Bank>,
    /// Number of bytes of the set that is written.
    len: usize,
    /// Position in the set that is being made.
    walk: Walk,
    has_orphans: bool,
    at: usize,
    filled: usize,
    crc: Crc32,
    buffer: [u8; MAX_WORD],
    place: Range<usize>,
}

/// The work of the next step.
#[derive(Clone, Debug)]
enum Phase {
    /// Reads the banks: the header of this one, its records, and the bytes after them.
    Head(usize),
    Records(usize, Bank, Content),
    Rest(usize, Bank, Rest),
    /// Counts the set, writes it, and reads it back.
    Count,
    Write,
    Wipe,
    Check(Content),
}

/// The end of a bank, of which all bytes so far are FFh or 0.
#[derive(Clone, Debug)]
struct Rest {
    at: usize,
    is_erased: bool,
    is_zero: bool,
}

impl Job {
    /// Begins a save. The values of the dictionary are copied to `values`, which has room for all
    /// of them.
    pub fn new(save: &Save<'_>, values: &mut [u8]) -> Self {
        let now = save.store.values();
        if let Some(to) = values.get_mut(..now.len()) {
            to.copy_from_slice(now);
        }
        let plan = if save.restores {
            Plan::Restore(save.sub)
        } else {
            Plan::Save(save.sub)
        };
        Self {
            plan,
            profile: *save.profile,
            node_id: save.store.node_id(),
            banks: Banks {
                device: save.device,
                ..Banks::NONE
            },
            phase: Phase::Head(0),
            first: None,
            len: 0,
            walk: Walk::NONE,
            has_orphans: true,
            at: 0,
            filled: 0,
            crc: Crc32::new(),
            buffer: [0; MAX_WORD],
            place: 0..0,
        }
    }

    /// Continues for at most 64 bytes, or eight values of the dictionary. `values` is the slice of
    /// [`new`](Self::new). Returns the result when the job is done.
    pub fn step(
        &mut self,
        storage: &mut dyn Storage,
        dictionary: &Dictionary<'_>,
        values: &mut [u8],
    ) -> Option<Result<(), StorageError>> {
        let Ok(store) = Store::new(dictionary, values, self.node_id) else {
            return Some(Err(StorageError::Full));
        };
        let mut banks = self.banks;
        let mut medium = Medium::new(storage, &mut banks);
        medium.buffer = self.buffer;
        let done = self.go_on(&mut medium, &store);
        self.buffer = medium.buffer;
        let outcome = medium.outcome;
        self.banks = banks;
        match outcome {
            Ok(()) => done.then_some(Ok(())),
            failed => Some(failed),
        }
    }

    /// Range of the newest set with its header after the job is done, as by
    /// [`newest`](super::newest).
    pub fn newest(&self) -> Range<usize> {
        self.place.clone()
    }

    /// Continues. Returns whether the job is done.
    fn go_on(&mut self, medium: &mut Medium<'_>, store: &Store<'_>) -> bool {
        match self.phase.clone() {
            Phase::Head(bank) => {
                if bank == 0 {
                    medium.banks.layout = Layout::of(medium.storage);
                }
                self.head(medium, bank)
            }
            Phase::Records(at, mut bank, mut content) => {
                if content.go_on(medium, STEP) {
                    bank.set = content.set(medium);
                    self.rest(medium, at, bank);
                } else {
                    self.phase = Phase::Records(at, bank, content);
                }
                false
            }
            Phase::Rest(at, bank, mut rest) => {
                let size = medium.banks.layout.size;
                let part = rest.at..(rest.at + STEP).min(at + size);
                rest.is_erased &= medium.holds(part.start, part.end, ERASED);
                rest.is_zero &= medium.holds(part.start, part.end, 0);
                rest.at = part.end;
                if rest.at < at + size && (rest.is_erased || rest.is_zero) {
                    self.phase = Phase::Rest(at, bank, rest);
                    return false;
                }
                let is_clean = bank.is_clean && (rest.is_erased || rest.is_zero);
                self.looked(medium, Bank { is_clean, ..bank })
            }
            Phase::Count => self.count(medium, store),
            Phase::Write => {
                if self.walk(medium, store, false) {
                    let word = medium.banks.layout.word;
                    self.put(medium, store, false, |set| set.write_out(word));
                    self.phase = Phase::Wipe;
                }
                false
            }
            Phase::Wipe => self.wipe(medium, store),
            Phase::Check(mut content) => {
                if !content.go_on(medium, STEP) {
                    self.phase = Phase::Check(content);
                    return false;
                }
                let set = content.set(medium);
                self.check(medium, set.map(|set| set.len.get()))
            }
        }
    }

    /// Reads the header of a bank.
    fn head(&mut self, medium: &mut Medium<'_>, at: usize) -> bool {
        if medium.banks.layout.size == 0 {
            return self.begin(medium);
        }
        let bank = medium.head(at);
        let content = if bank.code.is_complete() {
            medium.open(at)
        } else {
            None
        };
        match content {
            Some(content) => self.phase = Phase::Records(at, bank, content),
            None if bank.code == Code::GIVEN_UP => return self.looked(medium, bank),
            None => self.rest(medium, at, bank),
        }
        false
    }

    /// Goes to the end of a bank.
    fn rest(&mut self, medium: &mut Medium<'_>, at: usize, bank: Bank) {
        let rest = Rest {
            at: at + bank.used(medium.banks.layout.word),
            is_erased: true,
            is_zero: true,
        };
        self.phase = Phase::Rest(at, bank, rest);
    }

    /// Notes a bank that was read.
    fn looked(&mut self, medium: &mut Medium<'_>, bank: Bank) -> bool {
        match self.first.take() {
            None => {
                self.first = Some(bank);
                self.phase = Phase::Head(medium.banks.layout.size);
                false
            }
            Some(first) => {
                medium.pair(&first, &bank);
                self.begin(medium)
            }
        }
    }

    /// Begins to write after both banks were read. The job is done if there is nothing to write.
    fn begin(&mut self, medium: &mut Medium<'_>) -> bool {
        let stays = medium.banks.stays;
        self.place = medium
            .banks
            .newest
            .map_or(0..0, |set| stays..stays + set.len.get());
        match medium.admits(&self.plan) {
            Ok(true) => {
                self.start(medium, 0);
                self.phase = Phase::Count;
                false
            }
            Ok(false) => true,
            Err(error) => {
                medium.fail(error);
                true
            }
        }
    }

    /// Goes to the first record.
    fn start(&mut self, medium: &mut Medium<'_>, at: usize) {
        self.at = at;
        self.walk = Walk::new(medium);
    }

    /// Counts once more without the records that have no object, if there is no room for them.
    fn count(&mut self, medium: &mut Medium<'_>, store: &Store<'_>) -> bool {
        if !self.walk(medium, store, true) {
            return false;
        }
        let header = medium.banks.layout.header;
        if self.at <= medium.banks.layout.size - header {
            self.len = self.at;
            medium.mark(&self.profile, &self.plan);
            let target = medium.banks.target;
            medium.clear(target, header + self.len);
            self.crc = Crc32::new();
            self.crc.update(self.fields(medium)[..2].as_flattened());
            self.start(medium, target + header);
            self.phase = Phase::Write;
        } else if self.has_orphans {
            self.has_orphans = false;
            self.start(medium, 0);
        } else {
            medium.fail(StorageError::Full);
        }
        false
    }

    /// The fields of the header.
    fn fields(&self, medium: &Medium<'_>) -> [[u8; 4]; 3] {
        [medium.banks.device, self.len as u32, self.crc.finish()].map(u32::to_le_bytes)
    }

    /// Clears the bytes after the records; then the fields follow.
    fn wipe(&mut self, medium: &mut Medium<'_>, store: &Store<'_>) -> bool {
        let Banks { target, layout, .. } = *medium.banks;
        let end = (self.at + STEP).min(target + layout.size);
        medium.wipe(self.at, end);
        self.at = end;
        if end < target + layout.size {
            return false;
        }
        let fields = self.fields(medium);
        self.at = target + 2 * layout.word;
        self.put(medium, store, false, |set| {
            set.put(Source::Bytes(fields.as_flattened()), FIELDS);
            set.write_out(layout.word);
        });
        medium.flush();
        match medium.open(target) {
            Some(content) => {
                self.phase = Phase::Check(content);
                false
            }
            None => self.check(medium, None),
        }
    }

    /// Checks the set that was read back, with this length.
    fn check(&mut self, medium: &mut Medium<'_>, len: Option<usize>) -> bool {
        let (target, whole) = (medium.banks.target, medium.banks.layout.header + self.len);
        if len != Some(whole) {
            medium.fail(StorageError::NotWritten);
            medium.give_up(target);
        }
        if medium.outcome.is_ok() && medium.commit().is_ok() {
            self.place = target..target + whole;
        }
        true
    }

    /// Calls `act` with the set that is being made.
    fn put(
        &mut self,
        medium: &mut Medium<'_>,
        store: &Store<'_>,
        only_counts: bool,
        act: impl FnOnce(&mut Set<'_, '_>),
    ) {
        let mut set = Set {
            medium,
            store,
            plan: &self.plan,
            has_orphans: self.has_orphans,
            only_counts,
            at: self.at,
            filled: self.filled,
            crc: self.crc,
        };
        act(&mut set);
        (self.at, self.filled, self.crc) = (set.at, set.filled, set.crc);
    }

    /// Handles some of the records. Returns whether these were the last.
    fn walk(&mut self, medium: &mut Medium<'_>, store: &Store<'_>, only_counts: bool) -> bool {
        let (mut walk, profile, mut done) = (self.walk.clone(), self.profile, false);
        self.put(medium, store, only_counts, |set| {
            done = walk.step(set, &profile);
        });
        self.walk = walk;
        done
    }
}
