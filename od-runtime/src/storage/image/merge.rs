//! Writing: the newest set and the store make the next set.

use od_model::{Address, Entry};

use super::bank::{Banks, in_chunks};
use super::cob_id;
use super::covered::{is_life_record, is_saved};
use super::layout::{HEADER, MAGIC, MAX_VALUE, OWN, RECORD, REPLACED, VERSION};
use crate::profile::{CutSave, SavedCobIds};
use crate::storage::crc::Crc32;
use crate::storage::{Storage, StorageError};
use crate::store::Store;

/// Part of an address in the next set.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Fate {
    /// The store's value goes in.
    Store,
    /// The record of the newest set stays, if there is one.
    Keep,
    /// Nothing goes in.
    Drop,
}

/// Recipe of the next set.
pub(super) struct Next<'n> {
    /// Decides for an address; without an entry where no object of the dictionary saves it.
    pub(super) plan: &'n dyn Fn(Address, Option<&Entry>) -> Fate,
    /// Node ID and bit rate of LSS, in records of their own. `plan` drops the old ones.
    pub(super) own: [Option<u8>; 2],
    /// Values after an interrupted save.
    pub(super) cut: CutSave,
    pub(super) cob_ids: SavedCobIds,
}

/// Not the start of a bank.
const NONE: usize = usize::MAX;

/// A set that is written but for its magic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Pending {
    target: usize,
    /// The set before it, if it does not count until then; else [`NONE`]. An `Option` here would keep
    /// a node without power from being all zeros.
    replaced: usize,
}

/// Writes the next set into the older bank, all but the magic.
pub(super) fn begin(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    banks: &Banks,
    next: &Next<'_>,
) -> Result<Pending, StorageError> {
    let room = banks.size.checked_sub(HEADER).ok_or(StorageError::Full)?;
    // Records without an object stay as long as there is room.
    let mut set = Set {
        store,
        banks,
        next,
        has_orphans: true,
    };
    let mut len = set.len(storage)?;
    if len > room {
        set.has_orphans = false;
        len = set.len(storage)?;
    }
    if len > room {
        return Err(StorageError::Full);
    }
    let pending = Pending {
        target: banks.target,
        replaced: match banks.newest {
            Some(bank) if next.cut == CutSave::Factory && !bank.replaced => bank.start,
            _ => NONE,
        },
    };
    if pending.replaced != NONE {
        storage.write(pending.replaced, &[REPLACED])?;
        storage.flush()?;
    }
    if let Err(error) = set.write(storage, len) {
        // Power did not go, so the set before it still counts, if it can be marked.
        let _ = reinstate(storage, pending);
        return Err(error);
    }
    Ok(pending)
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
        NONE => Ok(()),
        start => storage.write(start, &MAGIC[..1]),
    }
}

/// The next set.
struct Set<'s> {
    store: &'s Store<'s>,
    banks: &'s Banks,
    next: &'s Next<'s>,
    /// With the records whose objects the dictionary does not have.
    has_orphans: bool,
}

impl Set<'_> {
    /// Bytes of its records.
    fn len(&self, storage: &mut dyn Storage) -> Result<usize, StorageError> {
        let mut writer = Writer::new(0, true);
        self.records(storage, &mut writer)?;
        Ok(writer.at)
    }

    /// Writes header and records.
    fn write(&self, storage: &mut dyn Storage, len: usize) -> Result<(), StorageError> {
        let target = self.banks.target;
        storage.write(target, &[0; MAGIC.len()])?;
        storage.flush()?;
        let mut header = [0; HEADER - MAGIC.len()];
        header[..2].copy_from_slice(&VERSION.to_le_bytes());
        header[4..8].copy_from_slice(&self.banks.next_sequence().to_le_bytes());
        // The length is less than a bank, which a header can describe: survey saw to it.
        header[8..12].copy_from_slice(&(len as u32).to_le_bytes());
        let mut writer = Writer::new(target + HEADER, false);
        writer.crc.update(&header[..12]);
        self.records(storage, &mut writer)?;
        writer.write_out(storage)?;
        header[12..].copy_from_slice(&writer.crc.finish().to_le_bytes());
        storage.write(target + MAGIC.len(), &header)?;
        storage.flush()
    }

    /// Goes through the newest set and the dictionary side by side, both by address.
    fn records(&self, storage: &mut dyn Storage, writer: &mut Writer) -> Result<(), StorageError> {
        for (sub, value) in (1..).zip(self.next.own) {
            if let Some(value) = value {
                writer.head(storage, Address::new(OWN, sub), 1)?;
                writer.put(storage, &[value])?;
            }
        }
        let mut records = self.banks.records();
        let entries = self.store.dictionary().entries();
        let mut entries = entries.filter(is_saved);
        let (mut record, mut entry) = (records.next(storage)?, entries.next());
        loop {
            let addresses = [record.map(|old| old.address), entry.map(|new| new.address)];
            let Some(address) = addresses.into_iter().flatten().min() else {
                return Ok(());
            };
            let old = record.filter(|old| old.address == address);
            let new = entry.as_ref().filter(|new| new.address == address);
            let fate = match (self.next.plan)(address, new) {
                // After a save that was cut the factory values hold, and they stay.
                Fate::Keep if self.banks.is_cut() && !new.is_some_and(is_life_record) => Fate::Drop,
                Fate::Keep if new.is_none() && address.index != OWN && !self.has_orphans => {
                    Fate::Drop
                }
                fate => fate,
            };
            match (fate, new, old) {
                (Fate::Store, Some(entry), _) => {
                    let mut number = [0; 8];
                    let bytes = self.store.bytes(entry, &mut number);
                    if bytes.len() > MAX_VALUE {
                        return Err(StorageError::Full);
                    }
                    writer.head(storage, address, bytes.len())?;
                    match cob_id::difference(self.store, entry, self.next.cob_ids) {
                        Some(difference) => {
                            writer.put(storage, &difference[..bytes.len().min(8)])?;
                        }
                        None => writer.put(storage, bytes)?,
                    }
                }
                (Fate::Keep, _, Some(old)) => {
                    writer.head(storage, address, old.len)?;
                    in_chunks(storage, old.at, old.len, |storage, part| {
                        writer.put(storage, part)
                    })?;
                }
                _ => {}
            }
            if old.is_some() {
                record = records.next(storage)?;
            }
            if new.is_some() {
                entry = entries.next();
            }
        }
    }
}

/// Gathers small writes and sums them up.
struct Writer {
    /// Place of the next byte that is written.
    at: usize,
    /// Nothing is written.
    only_counts: bool,
    buffer: [u8; 64],
    filled: usize,
    crc: Crc32,
}

impl Writer {
    fn new(at: usize, only_counts: bool) -> Self {
        Self {
            at,
            only_counts,
            buffer: [0; 64],
            filled: 0,
            crc: Crc32::new(),
        }
    }

    /// Begins a record.
    fn head(
        &mut self,
        storage: &mut dyn Storage,
        address: Address,
        len: usize,
    ) -> Result<(), StorageError> {
        let [index_low, index_high] = address.index.to_le_bytes();
        // MAX_VALUE and the records' own length field keep it below 64 KiB.
        let [len_low, len_high] = (len as u16).to_le_bytes();
        let head: [u8; RECORD] = [index_low, index_high, address.sub, len_low, len_high];
        self.put(storage, &head)
    }

    fn put(&mut self, storage: &mut dyn Storage, mut bytes: &[u8]) -> Result<(), StorageError> {
        if self.only_counts {
            self.at += bytes.len();
            return Ok(());
        }
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

    fn write_out(&mut self, storage: &mut dyn Storage) -> Result<(), StorageError> {
        storage.write(self.at, &self.buffer[..self.filled])?;
        self.at += self.filled;
        self.filled = 0;
        Ok(())
    }
}
