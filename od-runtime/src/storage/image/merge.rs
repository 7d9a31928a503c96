//! Writing: the newest set and the store make the next set.

use od_model::Address;
use od_model::row::Row;

use super::bank::{Banks, Record, content, device};
use super::cob_id;
use super::covered::{is_life_record, is_saved};
use super::layout::{
    Code, ERASED, Layout, MAX_VALUE, MAX_WORD, OWN, RECORD, is_blank, whole_words,
};
use super::loaded::Loaded;
use crate::number::copy;
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
    /// Nothing is written where this is what is there.
    pub(super) unless: Option<Loaded>,
    /// Decides for an address; without an entry where no object of the dictionary saves it.
    pub(super) plan: &'n dyn Fn(Address, Option<&Row>) -> Fate,
    /// Node ID and bit rate of LSS, in records of their own. `plan` drops the old ones.
    pub(super) own: [Option<u8>; 2],
    /// Values after an interrupted save.
    pub(super) cut: CutSave,
    pub(super) cob_ids: SavedCobIds,
}

/// A set that is written but for its commit word.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Pending {
    layout: Layout,
    target: usize,
    code: Code,
}

impl Pending {
    /// No set.
    pub(crate) const NONE: Self = Self {
        layout: Layout::NONE,
        target: 0,
        code: Code::ERASED,
    };

    /// Whether there is a set.
    pub(crate) const fn is_some(&self) -> bool {
        self.layout.size > 0
    }
}

/// Writes the next set, if there is to be one.
pub(super) fn save(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    next: &Next<'_>,
) -> Result<(), StorageError> {
    let mut pending = Pending::NONE;
    begin(storage, store, next, &mut pending)?;
    match pending.is_some() {
        true => commit(storage, &pending),
        false => Ok(()),
    }
}

/// Writes the next set into the older bank, all but the commit word.
#[inline(never)]
pub(super) fn begin(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    next: &Next<'_>,
    pending: &mut Pending,
) -> Result<(), StorageError> {
    let mut banks = Banks::of(device(store.dictionary()));
    banks.survey(storage)?;
    let banks = &banks;
    if next.unless == Some(banks.state) {
        return Ok(());
    }
    let layout = &banks.layout;
    let room = layout.size.checked_sub(layout.header());
    let room = room.ok_or(StorageError::Full)?;
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
    *pending = Pending {
        layout: banks.layout,
        target: banks.target,
        code: banks.next,
    };
    // Once it does not count, only a complete set ends that.
    let mark = match next.cut {
        CutSave::LastSet if !banks.is_withdrawn => Code::REPLACED,
        _ => Code::WITHDRAWN,
    };
    match layout.stamp(storage, banks.stays + layout.word, mark) {
        // A mark that power or a save before this one left in flash stays as it is.
        Err(StorageError::NotWritten) if layout.page > 0 => {}
        result => result?,
    }
    let written = set.write(storage, len);
    written.map_err(|error| give_up(storage, pending, error))
}

/// The commit word: from now on the next set is the newest.
pub(crate) fn commit(storage: &mut dyn Storage, pending: &Pending) -> Result<(), StorageError> {
    let layout = &pending.layout;
    let written = layout.stamp(storage, pending.target, pending.code);
    match layout.page {
        0 => written.map_err(|error| give_up(storage, pending, error)),
        // A word of flash is written once.
        _ => written,
    }
}

/// Power did not go, so the set before the next one counts, if the storage still works.
fn give_up(storage: &mut dyn Storage, pending: &Pending, error: StorageError) -> StorageError {
    let _ = pending
        .layout
        .stamp(storage, pending.target, Code::GIVEN_UP);
    error
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
    #[inline(never)]
    fn len(&self, storage: &mut dyn Storage) -> Result<usize, StorageError> {
        let mut writer = Writer::new(0, true);
        self.records(storage, &mut writer)?;
        Ok(writer.at)
    }

    /// Writes records and fields, and reads them back. Its parts are apart for the sake of the stack.
    #[inline(always)]
    fn write(&self, storage: &mut dyn Storage, len: usize) -> Result<(), StorageError> {
        let (layout, target) = (&self.banks.layout, self.banks.target);
        layout.clear(storage, target, layout.header() + len)?;
        // The length is less than a bank, which a header can describe.
        let [mut fields @ .., _] = [self.banks.device, len as u32, 0, 0].map(u32::to_le_bytes);
        fields[2] = self.write_records(storage, &fields)?;
        self.write_fields(storage, &fields)?;
        let whole = content(storage, layout, target)?;
        match whole.is_some_and(|set| set.len == len) {
            true => Ok(()),
            false => Err(StorageError::NotWritten),
        }
    }

    /// Writes the records, and clears what is behind them. Returns the sum of the fields and them.
    #[inline(never)]
    fn write_records(
        &self,
        storage: &mut dyn Storage,
        fields: &[[u8; 4]; 3],
    ) -> Result<[u8; 4], StorageError> {
        let (layout, target) = (&self.banks.layout, self.banks.target);
        let mut writer = Writer::new(target + layout.header(), false);
        writer.crc.update(&fields[0]);
        writer.crc.update(&fields[1]);
        self.records(storage, &mut writer)?;
        writer.write_out(storage, layout.word)?;
        // Behind the records nothing stays of older sets; flash is erased there.
        let end = target + layout.size;
        writer.buffer = [ERASED; BUFFER];
        while layout.page == 0 && writer.at < end {
            let part = (end - writer.at).min(writer.buffer.len());
            if !is_blank(storage, writer.at, part)? {
                storage.write(writer.at, writer.buffer.get(..part).unwrap_or_default())?;
            }
            writer.at += part;
        }
        Ok(writer.crc.finish().to_le_bytes())
    }

    /// Writes the fields of the header.
    #[inline(never)]
    fn write_fields(
        &self,
        storage: &mut dyn Storage,
        known: &[[u8; 4]; 3],
    ) -> Result<(), StorageError> {
        let (layout, target) = (&self.banks.layout, self.banks.target);
        let mut fields = [ERASED; MAX_WORD];
        copy(&mut fields, known.as_flattened());
        let len = layout.header() - 2 * layout.word;
        let fields = fields.get(..len).unwrap_or_default();
        storage.write(target + 2 * layout.word, fields)?;
        storage.flush()
    }

    /// Goes through the newest set and the dictionary side by side, both by address.
    #[inline(never)]
    fn records(&self, storage: &mut dyn Storage, writer: &mut Writer) -> Result<(), StorageError> {
        for (sub, value) in (1..).zip(self.next.own) {
            if let Some(value) = value {
                writer.head(storage, Address::new(OWN, sub), 1)?;
                writer.put(storage, &[value])?;
            }
        }
        let mut old = self.banks.records();
        let rows = self.store.dictionary().rows().iter();
        let mut rows = rows.filter(|row| is_saved(row));
        let (mut has_old, mut next) = (old.next(storage)?, rows.next());
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
                (Fate::Store, Some(row)) => self.value(storage, writer, row)?,
                (Fate::Keep, _) if is_old => writer.copy(storage, &old.record)?,
                _ => {}
            }
            if is_old {
                has_old = old.next(storage)?;
            }
            if is_new {
                next = rows.next();
            }
        }
    }

    /// Decides about the value of an address.
    #[inline(never)]
    fn fate(&self, address: Address, new: Option<&Row>) -> Fate {
        match (self.next.plan)(address, new) {
            // After a save that was cut the factory values hold, and they stay.
            Fate::Keep if self.banks.is_withdrawn && !new.is_some_and(is_life_record) => Fate::Drop,
            Fate::Keep if new.is_none() && address.index != OWN && !self.has_orphans => Fate::Drop,
            fate => fate,
        }
    }

    /// The record of a value of the store.
    #[inline(never)]
    fn value(
        &self,
        storage: &mut dyn Storage,
        writer: &mut Writer,
        row: &Row,
    ) -> Result<(), StorageError> {
        let mut number = [0; 8];
        let mut bytes = self.store.value(row, &mut number);
        if bytes.len() > MAX_VALUE {
            return Err(StorageError::Full);
        }
        writer.head(storage, row.address(), bytes.len())?;
        let (mut difference, len) = ([0; 8], bytes.len());
        if cob_id::difference(self.store, row, self.next.cob_ids, bytes, &mut difference) {
            bytes = difference.get(..len).unwrap_or(bytes);
        }
        writer.put(storage, bytes)
    }
}

/// Past the last address.
const END: u32 = u32::MAX;

/// Bytes of a write: the longest word.
const BUFFER: usize = 32;

/// Gathers small writes and sums them up.
struct Writer {
    /// Place of the next byte that is written.
    at: usize,
    /// Nothing is written.
    only_counts: bool,
    buffer: [u8; BUFFER],
    filled: usize,
    crc: Crc32,
}

impl Writer {
    fn new(at: usize, only_counts: bool) -> Self {
        Self {
            at,
            only_counts,
            buffer: [0; BUFFER],
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

    #[inline(never)]
    fn put(&mut self, storage: &mut dyn Storage, mut bytes: &[u8]) -> Result<(), StorageError> {
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
                self.write_out(storage, 1)?;
            }
        }
        Ok(())
    }

    /// Puts a record that the storage has.
    #[inline(never)]
    fn copy(&mut self, storage: &mut dyn Storage, old: &Record) -> Result<(), StorageError> {
        let (mut from, mut len) = (old.at, old.len);
        self.head(storage, old.address, len)?;
        if self.only_counts {
            self.at += len;
            return Ok(());
        }
        while len > 0 {
            let room = self.buffer.get_mut(self.filled..).unwrap_or_default();
            let part = len.min(room.len());
            let room = room.get_mut(..part).unwrap_or_default();
            storage.read(from, room)?;
            self.crc.update(room);
            self.filled += part;
            (from, len) = (from + part, len - part);
            if self.filled == self.buffer.len() {
                self.write_out(storage, 1)?;
            }
        }
        Ok(())
    }

    /// Writes the buffer, with the rest of its last word.
    fn write_out(&mut self, storage: &mut dyn Storage, word: usize) -> Result<(), StorageError> {
        let end = whole_words(self.filled, word);
        let rest = self.buffer.get_mut(self.filled..end).unwrap_or_default();
        rest.iter_mut().for_each(|byte| *byte = ERASED);
        storage.write(self.at, self.buffer.get(..end).unwrap_or_default())?;
        self.at += end;
        self.filled = 0;
        Ok(())
    }
}
