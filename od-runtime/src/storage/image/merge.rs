//! Writing: the newest set and the store make the next set.

use core::cmp::Ordering;

use od_model::{Address, Entry};

use super::bank::{Banks, MAGIC, REPLACED, Record, Records, VERSION};
use super::{HEADER, MAX_VALUE, RECORD, cob_id, is_life_record, is_saved};
use crate::profile::{CutSave, SavedCobIds};
use crate::storage::crc::Crc32;
use crate::storage::{Storage, StorageError};
use crate::store::Store;

/// What becomes of an address in the next set.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Fate {
    /// The store's value goes in.
    Store,
    /// What the newest set says stays; nothing, if it says nothing.
    Keep,
    /// Nothing goes in.
    Drop,
}

/// Decides for an address; without an entry where no object of the dictionary saves it.
pub(super) type Plan<'p> = &'p dyn Fn(Address, Option<&Entry>) -> Fate;

/// One record of the next set.
enum Item<'i> {
    New(&'i Entry, &'i [u8]),
    Old(Record),
}

/// What the next set is made of, and how.
#[derive(Clone, Copy)]
pub(super) struct Next<'n> {
    pub(super) plan: Plan<'n>,
    /// What is left where power goes before the end.
    pub(super) cut: CutSave,
    pub(super) cob_ids: SavedCobIds,
}

/// A set that is written but for its magic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Pending {
    target: usize,
    /// The set before it, if it does not count until then.
    replaced: Option<usize>,
}

/// Writes the next set into the older bank, all but the magic.
pub(super) fn begin(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    banks: &Banks,
    next: Next<'_>,
) -> Result<Pending, StorageError> {
    let room = banks.size.checked_sub(HEADER).ok_or(StorageError::Full)?;
    let plan: Plan<'_> = &|address, entry| match (next.plan)(address, entry) {
        // After a save that was cut the factory values hold, and they stay.
        Fate::Keep if banks.is_cut() && !entry.is_some_and(is_life_record) => Fate::Drop,
        fate => fate,
    };
    let without_orphans: Plan<'_> = &|address, entry| match entry {
        Some(_) => plan(address, entry),
        None => Fate::Drop,
    };
    // Records without an object stay as long as there is room.
    let mut plan = plan;
    let mut len = length(storage, store, banks, plan)?;
    if len > room {
        plan = without_orphans;
        len = length(storage, store, banks, plan)?;
    }
    if len > room {
        return Err(StorageError::Full);
    }

    let replaced = match banks.newest {
        Some(bank) if next.cut == CutSave::Factory && !bank.replaced => Some(bank.start),
        _ => None,
    };
    if let Some(start) = replaced {
        storage.write(start, &[REPLACED])?;
        storage.flush()?;
    }
    let pending = Pending {
        target: banks.target,
        replaced,
    };
    match fill(storage, store, banks, plan, len, next.cob_ids) {
        Ok(()) => Ok(pending),
        Err(error) => {
            // Power did not go, so the set before it still counts, if it can be told.
            let _ = reinstate(storage, pending);
            Err(error)
        }
    }
}

/// The magic: from now on the next set is the newest.
pub(crate) fn commit(storage: &mut dyn Storage, pending: Pending) -> Result<(), StorageError> {
    storage.write(pending.target, &MAGIC)?;
    storage.flush()?;
    reinstate(storage, pending)
}

/// The set before the next one is what it was.
fn reinstate(storage: &mut dyn Storage, pending: Pending) -> Result<(), StorageError> {
    match pending.replaced {
        Some(start) => storage.write(start, &MAGIC[..1]),
        None => Ok(()),
    }
}

/// Header and records of the next set.
fn fill(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    banks: &Banks,
    plan: Plan<'_>,
    len: usize,
    cob_ids: SavedCobIds,
) -> Result<(), StorageError> {
    storage.write(banks.target, &[0; MAGIC.len()])?;
    storage.flush()?;
    let mut header = [0; HEADER - MAGIC.len()];
    header[..2].copy_from_slice(&VERSION.to_le_bytes());
    header[4..8].copy_from_slice(&banks.next_sequence().to_le_bytes());
    // The length is less than a bank, which a header can describe: survey saw to it.
    header[8..12].copy_from_slice(&(len as u32).to_le_bytes());
    let mut writer = Writer::new(banks.target + HEADER);
    writer.crc.update(&header[..12]);
    walk(storage, store, banks, plan, &mut |storage, item| {
        let (address, len) = match item {
            Item::New(entry, bytes) => (entry.address, bytes.len()),
            Item::Old(record) => (record.address, record.len),
        };
        let [index_low, index_high] = address.index.to_le_bytes();
        // MAX_VALUE and the records' own length field keep it below 64 KiB.
        let [len_low, len_high] = (len as u16).to_le_bytes();
        let head = [index_low, index_high, address.sub, len_low, len_high];
        writer.put(storage, &head)?;
        match item {
            Item::New(entry, bytes) => match cob_id::difference(store, entry, cob_ids) {
                Some(difference) => writer.put(storage, &difference[..len.min(8)]),
                None => writer.put(storage, bytes),
            },
            Item::Old(record) => writer.copy(storage, record),
        }
    })?;
    let crc = writer.finish(storage)?;
    header[12..].copy_from_slice(&crc.to_le_bytes());
    storage.write(banks.target + MAGIC.len(), &header)?;
    storage.flush()
}

/// Bytes of records that a plan makes.
fn length(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    banks: &Banks,
    plan: Plan<'_>,
) -> Result<usize, StorageError> {
    let mut len = 0;
    walk(storage, store, banks, plan, &mut |_, item| {
        len += RECORD
            + match item {
                Item::New(_, bytes) if bytes.len() > MAX_VALUE => return Err(StorageError::Full),
                Item::New(_, bytes) => bytes.len(),
                Item::Old(record) => record.len,
            };
        Ok(())
    })?;
    Ok(len)
}

type Sink<'s> = &'s mut dyn FnMut(&mut dyn Storage, Item<'_>) -> Result<(), StorageError>;

/// Goes through the newest set and the dictionary side by side, both by address.
fn walk(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    banks: &Banks,
    plan: Plan<'_>,
    sink: Sink<'_>,
) -> Result<(), StorageError> {
    let mut records = banks.newest.map(Records::new);
    let mut next = |storage: &mut dyn Storage| match &mut records {
        Some(records) => records.next(storage),
        None => Ok(None),
    };
    let mut entries = store.dictionary().entries().iter().filter(|e| is_saved(e));
    let mut record = next(storage)?;
    let mut entry = entries.next();
    loop {
        let order = match (&record, entry) {
            (None, None) => return Ok(()),
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (Some(record), Some(entry)) => record.address.cmp(&entry.address),
        };
        let old = if order.is_le() {
            let old = record.take();
            record = next(storage)?;
            old
        } else {
            None
        };
        let current = if order.is_ge() {
            let current = entry;
            entry = entries.next();
            current
        } else {
            None
        };
        let Some(address) = current.map(|e| e.address).or(old.map(|r| r.address)) else {
            return Ok(());
        };
        match (plan(address, current), current, old) {
            (Fate::Store, Some(entry), _) => {
                let mut number = [0; 8];
                sink(storage, Item::New(entry, store.bytes(entry, &mut number)))?;
            }
            (Fate::Keep, _, Some(old)) => sink(storage, Item::Old(old))?,
            _ => {}
        }
    }
}

/// Gathers small writes and sums them up.
struct Writer {
    at: usize,
    buffer: [u8; 64],
    filled: usize,
    crc: Crc32,
}

impl Writer {
    fn new(at: usize) -> Self {
        Self {
            at,
            buffer: [0; 64],
            filled: 0,
            crc: Crc32::new(),
        }
    }

    fn put(&mut self, storage: &mut dyn Storage, mut bytes: &[u8]) -> Result<(), StorageError> {
        self.crc.update(bytes);
        while !bytes.is_empty() {
            let part = bytes.len().min(self.buffer.len() - self.filled);
            self.buffer[self.filled..self.filled + part].copy_from_slice(&bytes[..part]);
            self.filled += part;
            bytes = &bytes[part..];
            if self.filled == self.buffer.len() {
                self.write_out(storage)?;
            }
        }
        Ok(())
    }

    fn copy(&mut self, storage: &mut dyn Storage, record: Record) -> Result<(), StorageError> {
        let mut chunk = [0; 64];
        let mut done = 0;
        while done < record.len {
            let part = (record.len - done).min(chunk.len());
            storage.read(record.at + done, &mut chunk[..part])?;
            self.put(storage, &chunk[..part])?;
            done += part;
        }
        Ok(())
    }

    fn write_out(&mut self, storage: &mut dyn Storage) -> Result<(), StorageError> {
        storage.write(self.at, &self.buffer[..self.filled])?;
        self.at += self.filled;
        self.filled = 0;
        Ok(())
    }

    fn finish(mut self, storage: &mut dyn Storage) -> Result<u32, StorageError> {
        self.write_out(storage)?;
        Ok(self.crc.finish())
    }
}
