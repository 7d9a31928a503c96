//! Writing: the newest set and the store make the next set.

use od_model::row::Row;
use od_model::{Address, Group};

use super::bank::{Banks, Record, content};
use super::cob_id;
use super::covered::{is_covered, is_life_record, is_saved, restores};
use super::layout::{Code, ERASED, Layout, MAX_VALUE, OWN, RECORD, is_blank, whole_words};
use super::loaded::Loaded;
use crate::number::{copy, number_in};
use crate::profile::{CutSave, StoreProfile};
use crate::storage::crc::Crc32;
use crate::storage::{Storage, StorageError};
use crate::store::Store;

/// Part of an address in the next set.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Fate {
    /// The store's value goes in.
    Store,
    /// The record of the newest set stays, if there is one.
    Keep,
    /// Nothing goes in.
    Drop,
}

/// Recipe of the next set.
#[derive(Clone, Copy)]
pub(crate) enum Plan<'p> {
    /// The values that this sub-index of 1010h covers, and the operating records; 0: only these.
    Save(u8),
    /// Without the values that this sub-index of 1011h covers.
    Restore(u8),
    /// The values that it names.
    Only(&'p dyn Fn(&Row) -> bool),
    /// Node ID and bit rate of LSS, in records of their own.
    Own([Option<u8>; 2]),
}

/// Writes the next set of a device, if there is to be one.
pub(crate) fn write(
    storage: &mut dyn Storage,
    device: u32,
    store: &Store<'_>,
    profile: &StoreProfile,
    plan: Plan<'_>,
) -> Result<(), StorageError> {
    let mut banks = Banks::NONE;
    banks.survey(storage, device)?;
    begin(storage, store, profile, &plan, &mut banks)?;
    commit(storage, &mut banks)
}

/// Writes the next set into the older one of two [surveyed](Banks::survey) banks, all but the commit word.
/// Without a next set they are [none](Banks::is_some).
#[inline(never)]
pub(crate) fn begin(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    profile: &StoreProfile,
    plan: &Plan<'_>,
    banks: &mut Banks,
) -> Result<(), StorageError> {
    match (plan, banks.state) {
        // The device itself writes nothing over the set of another one.
        (Plan::Save(0), Loaded::Foreign) => return Err(StorageError::Foreign),
        (Plan::Restore(_), Loaded::Blank) => {
            banks.layout = Layout::NONE;
            return Ok(());
        }
        _ => {}
    }
    let layout = &banks.layout;
    let room = layout.size.checked_sub(layout.header());
    let room = room.ok_or(StorageError::Full)?;
    // Records without an object stay as long as there is room.
    let mut set = Set {
        store,
        profile,
        plan,
        banks,
        has_orphans: true,
    };
    let mut writer = Writer::new(storage);
    set.records(&mut writer)?;
    if writer.at > room {
        set.has_orphans = false;
        writer.at = 0;
        set.records(&mut writer)?;
    }
    if writer.at > room {
        return Err(StorageError::Full);
    }
    // The device's own saves, and a restore, take nothing away when they are cut. Once the set does not
    // count, only a complete one ends that.
    let cut = match plan {
        Plan::Save(0) | Plan::Restore(_) => CutSave::LastSet,
        _ => profile.cut,
    };
    let mark = match cut {
        CutSave::LastSet if !banks.is_withdrawn => Code::REPLACED,
        _ => Code::WITHDRAWN,
    };
    match layout.stamp(writer.storage, banks.stays + layout.word, mark) {
        // A mark that power or a save before this one left in flash stays as it is.
        Err(StorageError::NotWritten) if layout.page > 0 => {}
        result => result?,
    }
    let written = set.write(&mut writer);
    written.map_err(|error| give_up(writer.storage, layout, banks.target, error))
}

/// The commit word, if there is a next set: from now on it is the newest.
pub(crate) fn commit(storage: &mut dyn Storage, banks: &mut Banks) -> Result<(), StorageError> {
    if !banks.is_some() {
        return Ok(());
    }
    let layout = core::mem::replace(&mut banks.layout, Layout::NONE);
    let written = layout.stamp(storage, banks.target, banks.next);
    match layout.page {
        0 => written.map_err(|error| give_up(storage, &layout, banks.target, error)),
        // A word of flash is written once.
        _ => written,
    }
}

/// Power did not go, so the set before the next one counts, if the storage still works.
fn give_up(
    storage: &mut dyn Storage,
    layout: &Layout,
    target: usize,
    error: StorageError,
) -> StorageError {
    let _ = layout.stamp(storage, target, Code::GIVEN_UP);
    error
}

/// The next set.
struct Set<'s> {
    store: &'s Store<'s>,
    profile: &'s StoreProfile,
    plan: &'s Plan<'s>,
    banks: &'s Banks,
    /// With the records whose objects the dictionary does not have.
    has_orphans: bool,
}

impl Set<'_> {
    /// Writes records and fields, and reads them back. The writer has counted the bytes of the records.
    fn write(&self, writer: &mut Writer<'_>) -> Result<(), StorageError> {
        let (layout, target) = (&self.banks.layout, self.banks.target);
        let len = writer.at;
        layout.clear(writer.storage, target, layout.header() + len)?;
        // The length is less than a bank, which a header can describe.
        let mut fields = [self.banks.device, len as u32, 0].map(u32::to_le_bytes);
        writer.begin(target + layout.header());
        writer.crc.update(fields[..2].as_flattened());
        self.records(writer)?;
        writer.write_out(layout.word)?;
        // Behind the records nothing stays of older sets; flash is erased there.
        let end = target + layout.size;
        writer.buffer = [ERASED; BUFFER];
        while layout.page == 0 && writer.at < end {
            let part = (end - writer.at).min(writer.buffer.len());
            if !is_blank(writer.storage, writer.at, part)? {
                let blank = writer.buffer.get(..part).unwrap_or_default();
                writer.storage.write(writer.at, blank)?;
            }
            writer.at += part;
        }
        fields[2] = writer.crc.finish().to_le_bytes();
        copy(&mut writer.buffer, fields.as_flattened());
        let fields = layout.header() - 2 * layout.word;
        let fields = writer.buffer.get(..fields).unwrap_or_default();
        writer.storage.write(target + 2 * layout.word, fields)?;
        writer.storage.flush()?;
        let whole = content(writer.storage, layout, target)?;
        match whole.is_some_and(|set| set.len == len) {
            true => Ok(()),
            false => Err(StorageError::NotWritten),
        }
    }

    /// Goes through the newest set and the dictionary side by side, both by address.
    #[inline(never)]
    fn records(&self, writer: &mut Writer<'_>) -> Result<(), StorageError> {
        if let Plan::Own(own) = self.plan {
            writer.own(own)?;
        }
        let mut old = self.banks.records();
        let rows = self.store.dictionary().rows().iter();
        let mut rows = rows.filter(|row| is_saved(row));
        let (mut has_old, mut next) = (old.next(writer.storage)?, rows.next());
        loop {
            let old_key = match has_old {
                true => old.record.address.key(),
                false => END,
            };
            let new_key = next.map_or(END, |row| row.key());
            if old_key == END && new_key == END {
                return Ok(());
            }
            let (is_old, is_new) = (old_key <= new_key, new_key <= old_key);
            let new = next.filter(|_| is_new);
            let address = new.map_or(old.record.address, |row| row.address());
            match (self.fate(address, new), new) {
                (Fate::Store, Some(row)) => self.value(writer, row)?,
                (Fate::Keep, _) if is_old => writer.copy(&old.record)?,
                _ => {}
            }
            if is_old {
                has_old = old.next(writer.storage)?;
            }
            if is_new {
                next = rows.next();
            }
        }
    }

    /// Decides about the value of an address; without a row where no object of the dictionary saves it.
    #[inline(never)]
    fn fate(&self, address: Address, new: Option<&Row>) -> Fate {
        let (profile, is_own) = (self.profile, address.index == OWN);
        let fate = match (*self.plan, new) {
            (Plan::Save(sub), Some(row))
                if is_covered(profile, row, sub) || is_life_record(row) =>
            {
                // One that was not changed follows the node ID.
                let follows = row.follows_node_id() && self.store.has_default(row);
                return if follows { Fate::Drop } else { Fate::Store };
            }
            (Plan::Restore(sub), Some(row)) if restores(profile, row, sub) => Fate::Drop,
            (Plan::Restore(sub), None) if Group::of_index(address.index).covered_by(sub) => {
                Fate::Drop
            }
            (Plan::Only(which), Some(row)) if which(row) => Fate::Store,
            (Plan::Own(_), _) if is_own => Fate::Drop,
            _ => Fate::Keep,
        };
        match fate {
            // After a save that was cut the factory values hold, and they stay.
            Fate::Keep if self.banks.is_withdrawn && !new.is_some_and(is_life_record) => Fate::Drop,
            Fate::Keep if new.is_none() && !is_own && !self.has_orphans => Fate::Drop,
            fate => fate,
        }
    }

    /// The record of a value of the store.
    #[inline(never)]
    fn value(&self, writer: &mut Writer<'_>, row: &Row) -> Result<(), StorageError> {
        let mut number = [0; 8];
        let mut bytes = self.store.value(row, &mut number);
        let len = bytes.len();
        if len > MAX_VALUE {
            return Err(StorageError::Full);
        }
        writer.head(row.address(), len)?;
        let base = cob_id::base(self.store, row, self.profile.cob_ids);
        if base != 0 {
            number = number_in(bytes).wrapping_sub(base).to_le_bytes();
            bytes = number.get(..len).unwrap_or_default();
        }
        writer.put(bytes)
    }
}

/// Past the last address.
const END: u32 = u32::MAX;

/// Bytes of a write: the longest word.
const BUFFER: usize = 32;

/// Gathers small writes and sums them up.
struct Writer<'w> {
    storage: &'w mut dyn Storage,
    /// Place of the next byte that is written.
    at: usize,
    /// Nothing is written.
    only_counts: bool,
    buffer: [u8; BUFFER],
    filled: usize,
    crc: Crc32,
}

impl<'w> Writer<'w> {
    /// One that only counts.
    fn new(storage: &'w mut dyn Storage) -> Self {
        Self {
            storage,
            at: 0,
            only_counts: true,
            buffer: [0; BUFFER],
            filled: 0,
            crc: Crc32::new(),
        }
    }

    /// Writes from here on.
    fn begin(&mut self, at: usize) {
        (self.at, self.only_counts) = (at, false);
    }

    /// Begins a record.
    #[inline(never)]
    fn head(&mut self, address: Address, len: usize) -> Result<(), StorageError> {
        let [index_low, index_high] = address.index.to_le_bytes();
        // MAX_VALUE and the records' own length field keep it below 64 KiB.
        let [len_low, len_high] = (len as u16).to_le_bytes();
        let head: [u8; RECORD] = [index_low, index_high, address.sub, len_low, len_high];
        self.put(&head)
    }

    #[inline(never)]
    fn put(&mut self, mut bytes: &[u8]) -> Result<(), StorageError> {
        if self.only_counts {
            self.at += bytes.len();
            return Ok(());
        }
        self.crc.update(bytes);
        while !bytes.is_empty() {
            let room = self.buffer.get_mut(self.filled..).unwrap_or_default();
            let part = bytes.len().min(room.len());
            copy(room, bytes);
            self.filled += part;
            bytes = bytes.get(part..).unwrap_or_default();
            if self.filled == self.buffer.len() {
                self.write_out(1)?;
            }
        }
        Ok(())
    }

    /// Records of node ID and bit rate.
    #[inline(never)]
    fn own(&mut self, own: &[Option<u8>; 2]) -> Result<(), StorageError> {
        for (sub, value) in (1..).zip(own) {
            if let Some(value) = value {
                self.head(Address::new(OWN, sub), 1)?;
                self.put(&[*value])?;
            }
        }
        Ok(())
    }

    /// Puts a record that the storage has.
    #[inline(never)]
    fn copy(&mut self, old: &Record) -> Result<(), StorageError> {
        let (mut from, mut len) = (old.at, old.len);
        self.head(old.address, len)?;
        if self.only_counts {
            self.at += len;
            return Ok(());
        }
        while len > 0 {
            let room = self.buffer.get_mut(self.filled..).unwrap_or_default();
            let part = len.min(room.len());
            let room = room.get_mut(..part).unwrap_or_default();
            self.storage.read(from, room)?;
            self.crc.update(room);
            self.filled += part;
            (from, len) = (from + part, len - part);
            if self.filled == self.buffer.len() {
                self.write_out(1)?;
            }
        }
        Ok(())
    }

    /// Writes the buffer, with the rest of its last word.
    fn write_out(&mut self, word: usize) -> Result<(), StorageError> {
        let end = whole_words(self.filled, word);
        let rest = self.buffer.get_mut(self.filled..end).unwrap_or_default();
        rest.iter_mut().for_each(|byte| *byte = ERASED);
        self.storage
            .write(self.at, self.buffer.get(..end).unwrap_or_default())?;
        self.at += end;
        self.filled = 0;
        Ok(())
    }
}
