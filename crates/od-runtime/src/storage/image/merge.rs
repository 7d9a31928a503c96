//! Writing: the next set is made of the newest set and the store.

use od_model::row::Row;
use od_model::{Address, Group};

use super::banks::{Banks, Loaded};
use super::cob_id;
use super::covered::{is_covered, is_life_record, is_saved};
use super::layout::{
    self, Code, ERASED, FIELDS, Layout, MAX_VALUE, MAX_WORD, OWN, RECORD, whole_words,
};
use super::medium::Medium;
use super::survey::END;
use crate::number::{copy, number_in};
use crate::profile::{CutSave, StoreProfile};
use crate::storage::crc::Crc32;
use crate::storage::{Storage, StorageError};
use crate::store::Store;

/// Content of the next set.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Plan<'p> {
    /// The values that this sub-index of 1010h covers, and the operating records; 0: only these.
    Save(u8),
    /// The newest set without the values that this sub-index of 1011h covers.
    Restore(u8),
    /// The values at these addresses.
    Only(&'p [Address]),
    /// Node ID and bit rate of LSS, in records of their own: [these](super::own_records) replace
    /// the earlier ones.
    Own(&'p [u8]),
}

/// Writes the next set of a device, if one is needed.
pub(crate) fn write(
    storage: &mut dyn Storage,
    device: u32,
    store: &Store<'_>,
    profile: &StoreProfile,
    plan: Plan<'_>,
) -> Result<(), StorageError> {
    let mut banks = Banks::NONE;
    let mut medium = Medium::new(storage, &mut banks);
    medium.survey(device)?;
    medium.begin(store, profile, &plan)?;
    medium.commit()
}

impl Medium<'_> {
    /// Writes the next set into the older one of two [surveyed](Medium::survey) banks, except its
    /// commit word. If no next set is needed, [`Banks::is_some`] returns `false`.
    pub(crate) fn begin(
        &mut self,
        store: &Store<'_>,
        profile: &StoreProfile,
        plan: &Plan<'_>,
    ) -> Result<(), StorageError> {
        let Layout {
            word, header, size, ..
        } = self.banks.layout;
        if !self.admits(plan)? {
            return Ok(());
        }
        let mut set = Set {
            medium: self,
            store,
            plan,
            has_orphans: true,
            only_counts: true,
            at: 0,
            filled: 0,
            crc: Crc32::new(),
        };
        // Records without an object stay as long as there is room.
        set.records(profile);
        if set.at > size - header {
            (set.has_orphans, set.at) = (false, 0);
            set.records(profile);
        }
        if set.at > size - header {
            set.medium.fail(StorageError::Full);
        }
        set.medium.outcome?;
        set.medium.mark(profile, plan);
        set.medium.outcome?;
        let (target, len) = (set.medium.banks.target, set.at);
        set.medium.clear(target, header + len);
        // The length is less than that of a bank, so the field can contain it.
        let mut fields = [set.medium.banks.device, len as u32, 0].map(u32::to_le_bytes);
        set.only_counts = false;
        set.at = target + header;
        set.crc.update(fields[..2].as_flattened());
        set.records(profile);
        set.write_out(word);
        set.medium.wipe(set.at, target + size);
        fields[2] = set.crc.finish().to_le_bytes();
        set.at = target + 2 * word;
        set.put(Source::Bytes(fields.as_flattened()), FIELDS);
        set.write_out(word);
        set.medium.flush();
        let whole = set.medium.content(target);
        if whole.is_none_or(|set| set.len.get() != header + len) {
            set.medium.fail(StorageError::NotWritten);
        }
        if set.medium.outcome.is_err() {
            set.medium.give_up(target);
        }
        set.medium.outcome
    }

    /// Returns whether the surveyed banks need and allow a next set.
    pub(super) fn admits(&mut self, plan: &Plan<'_>) -> Result<bool, StorageError> {
        match (plan, self.banks.state) {
            // Only a command of a master replaces the set of another device.
            (Plan::Save(0), Loaded::Foreign) => Err(StorageError::Foreign),
            (Plan::Restore(_), Loaded::Blank) => {
                self.banks.next = Code::ERASED;
                Ok(false)
            }
            _ if self.banks.layout.size == 0 => Err(StorageError::Full),
            _ => Ok(true),
        }
    }

    /// Marks the newest set when a save that replaces it begins.
    pub(super) fn mark(&mut self, profile: &StoreProfile, plan: &Plan<'_>) {
        // A save that the device started, or a restore, removes no values when it is interrupted.
        // If the set is not valid any more, only a complete set ends this state.
        let cut = match plan {
            Plan::Save(0) | Plan::Restore(_) => CutSave::LastSet,
            _ => profile.cut,
        };
        let mark = match cut {
            CutSave::LastSet if !self.banks.is_withdrawn => Code::REPLACED,
            _ => Code::WITHDRAWN,
        };
        let Banks { stays, layout, .. } = *self.banks;
        self.stamp(stays + layout.word, mark);
        // The mark of an interrupted or earlier save stays in flash as it is.
        if layout.page > 0 && self.outcome == Err(StorageError::NotWritten) {
            self.outcome = Ok(());
        }
    }

    /// Writes the commit word, if there is a next set; from then on it is the newest.
    pub(crate) fn commit(&mut self) -> Result<(), StorageError> {
        if self.banks.is_some() {
            let Banks { target, next, .. } = *self.banks;
            self.stamp(target, next);
            self.banks.next = Code::ERASED;
            // A word of flash is written once.
            if self.outcome.is_err() && self.banks.layout.page == 0 {
                self.give_up(target);
            }
        }
        self.outcome
    }
}

/// The next set. Small writes are collected, and the checksum is computed.
pub(super) struct Set<'s, 'm> {
    pub(super) medium: &'s mut Medium<'m>,
    pub(super) store: &'s Store<'s>,
    pub(super) plan: &'s Plan<'s>,
    /// Includes records whose objects the dictionary does not have.
    pub(super) has_orphans: bool,
    /// Only counts bytes and writes nothing.
    pub(super) only_counts: bool,
    /// Position of the next byte to write.
    pub(super) at: usize,
    pub(super) filled: usize,
    pub(super) crc: Crc32,
}

/// Source of bytes of a set.
#[derive(Clone, Copy)]
pub(super) enum Source<'b> {
    Bytes(&'b [u8]),
    /// This position in the storage.
    Storage(usize),
}

/// Origin of a record of the next set.
pub(super) enum Origin {
    Store,
    /// The newest set.
    Newest,
    None,
}

impl Set<'_, '_> {
    /// Merges the newest set and the dictionary, which are both sorted by address.
    fn records(&mut self, profile: &StoreProfile) {
        if let Plan::Own(own) = self.plan {
            self.put(Source::Bytes(own), own.len());
        }
        let mut old = self.medium.records();
        old.next(self.medium);
        let mut rows = self.store.dictionary().rows().iter();
        loop {
            let row = rows.find(|row| is_saved(row));
            let key = row.map_or(END, |row| row.key());
            while old.key < key {
                if self.keeps(old.key) {
                    self.put(Source::Storage(old.at - RECORD), RECORD + old.len);
                }
                old.next(self.medium);
            }
            let Some(row) = row else { return };
            let is_old = old.key == key;
            match self.origin(profile, row, is_old) {
                Origin::Store => self.value(profile, row),
                Origin::Newest => self.put(Source::Storage(old.at - RECORD), RECORD + old.len),
                Origin::None => {}
            }
            if is_old {
                old.next(self.medium);
            }
        }
    }

    /// Returns whether a record without an object stays.
    pub(super) fn keeps(&self, key: u32) -> bool {
        let index = (key >> 8) as u16;
        let is_dropped = match *self.plan {
            Plan::Restore(sub) => Group::of_index(index).covered_by(sub),
            Plan::Own(_) => index == OWN,
            _ => false,
        };
        // After an interrupted save the factory values are valid, and stay.
        !is_dropped && !self.medium.banks.is_withdrawn && (index == OWN || self.has_orphans)
    }

    /// Returns where the record of a row comes from. `is_old`: the newest set has one.
    pub(super) fn origin(&self, profile: &StoreProfile, row: &Row, is_old: bool) -> Origin {
        if self.is_meant(profile, row) {
            if self.goes_in(row) {
                Origin::Store
            } else {
                Origin::None
            }
        } else if is_old && (!self.medium.banks.is_withdrawn || is_life_record(row)) {
            Origin::Newest
        } else {
            Origin::None
        }
    }

    /// Returns whether the plan covers a value.
    fn is_meant(&self, profile: &StoreProfile, row: &Row) -> bool {
        match *self.plan {
            Plan::Save(_) if is_life_record(row) => true,
            Plan::Restore(_) if is_life_record(row) => false,
            Plan::Save(sub) | Plan::Restore(sub) => is_covered(profile, row, sub),
            Plan::Only(addresses) => addresses.contains(&row.address()),
            Plan::Own(_) => false,
        }
    }

    /// Returns whether a value that the plan covers is saved.
    fn goes_in(&self, row: &Row) -> bool {
        match self.plan {
            Plan::Restore(_) => false,
            // An unchanged default with `$NODEID` follows the node ID.
            Plan::Save(_) => !self.store.follows_node_id(row),
            _ => true,
        }
    }

    /// Writes the record of a value of the store.
    pub(super) fn value(&mut self, profile: &StoreProfile, row: &Row) {
        let bytes = self.store.stored(row);
        if bytes.len() > MAX_VALUE {
            return self.medium.fail(StorageError::Full);
        }
        self.head(row.key(), bytes.len());
        match cob_id::base(self.store, row, profile.cob_ids) {
            0 => self.put(Source::Bytes(bytes), bytes.len()),
            base => self.difference(bytes, base),
        }
    }

    /// Writes a part of the record of a value: these bytes, and before the first one the head of
    /// the record.
    pub(super) fn part(&mut self, row: &Row, done: usize, len: usize) {
        let bytes = self.store.stored(row);
        if bytes.len() > MAX_VALUE {
            return self.medium.fail(StorageError::Full);
        }
        if done == 0 {
            self.head(row.key(), bytes.len());
        }
        self.put(Source::Bytes(bytes.get(done..).unwrap_or_default()), len);
    }

    /// Subtracts the default from a value.
    fn difference(&mut self, bytes: &[u8], base: u64) {
        let less = number_in(bytes).wrapping_sub(base).to_le_bytes();
        self.put(Source::Bytes(&less), bytes.len());
    }

    /// Writes the head of a record.
    fn head(&mut self, key: u32, len: usize) {
        // [`MAX_VALUE`] and the length field of records keep it below 64 KiB.
        self.put(Source::Bytes(&layout::head(key, len as u16)), RECORD);
    }

    /// Writes this number of bytes.
    pub(super) fn put(&mut self, source: Source<'_>, len: usize) {
        if self.only_counts {
            self.at += len;
            return;
        }
        let mut done = 0;
        while done < len {
            let room = self.medium.buffer.get_mut(self.filled..);
            let room = room.unwrap_or_default();
            let part = room.len().min(len - done);
            let room = room.get_mut(..part).unwrap_or_default();
            match source {
                Source::Bytes(bytes) => copy(room, bytes.get(done..).unwrap_or_default()),
                Source::Storage(at) => {
                    if self.medium.outcome.is_ok() {
                        self.medium.outcome = self.medium.storage.read(at + done, room)
                    }
                }
            }
            self.crc.update(room);
            done += part;
            self.filled += part;
            if self.filled == MAX_WORD {
                self.write_out(1);
            }
        }
    }

    /// Writes the buffer, and fills its last word.
    pub(super) fn write_out(&mut self, word: usize) {
        let end = whole_words(self.filled, word);
        let rest = self.medium.buffer.get_mut(self.filled..end);
        let rest = rest.unwrap_or_default();
        rest.iter_mut().for_each(|byte| *byte = ERASED);
        let at = self.at;
        (self.at, self.filled) = (at + end, 0);
        self.medium.write(at, end);
    }
}
