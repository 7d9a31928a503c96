//! The saved values: 1010h writes them, 1011h removes them, and power-on reads them.
//!
//! The storage is two banks of whole pages, and a save writes the older one. A bank, in words of the
//! storage ([`Geometry::word`](super::Geometry::word), w bytes, 1 in an EEPROM):
//!
//! | bytes | content |
//! |---|---|
//! | w | commit word, written last: one of five codes, each newer than the one before it |
//! | w | mark: set when a save begins that replaces this set |
//! | 4 | device: CRC-32 of the version of this layout (2), vendor-ID and product code (1018h) |
//! | 4 | length of the records |
//! | 4 | CRC-32 of the two numbers and the records |
//! | … | FFh to the end of the word |
//! | … | records, by ascending address: index (2), sub-index (1), length (2), value |
//! | … | FFh to the end of the bank |
//!
//! Numbers are little-endian. A save marks the newest set, clears the other bank (flash: erases
//! it), writes records and numbers, reads them back, and writes the commit word. So a power failure
//! at any moment leaves the last complete set, never a mixture. The mark tells a later start that a
//! save was interrupted; some families then load the factory values
//! ([`CutSave::Factory`](crate::CutSave::Factory)). Each word is written once after it was erased,
//! and a bank of one page is erased once for each save.
//!
//! Any two codes differ in at least four bits, as do any two marks, and every other byte is covered
//! by the CRC or is FFh. So a start notices any flipped bit ([`Loaded`]), and always knows which of
//! two sets is newer.
//!
//! A set of another device, or of another version of this layout, is [`Loaded::Foreign`]. It stays
//! until a master saves or restores; the device itself does not save over it.
//!
//! A value has the bytes of an SDO transfer. If a family saves COB-IDs as differences
//! ([`SavedCobIds::Difference`](crate::profile::SavedCobIds)), a COB-ID whose default contains
//! `$NODEID` is saved minus its default.
//!
//! Records are found by address, so a firmware with another dictionary can read an image. A record
//! that does not fit is not loaded, but stays in the image as long as there is room.

use core::ops::Range;

use od_model::row::Row;
use od_model::{Address, Dictionary};

use super::{Storage, StorageError};
use crate::limits;
use crate::profile::StoreProfile;
use crate::store::Store;

mod banks;
mod cob_id;
mod covered;
mod job;
mod layout;
mod medium;
mod merge;
mod survey;
mod walk;

use banks::Set;
use covered::is_saved;
use layout::{OWN, RECORD};
use survey::{END, Records};

pub(crate) use banks::Banks;
pub use banks::Loaded;
pub(crate) use covered::is_kept;
pub use covered::{is_life_record, restores};
pub use job::Job;
pub use layout::MAX_VALUE;
pub(crate) use layout::own_records;
pub(crate) use medium::Medium;
pub(crate) use merge::{Plan, write};
pub use survey::device;

/// Returns the number of EEPROM bytes that `dictionary` needs to save every value at its greatest
/// length, twice.
pub const fn capacity_needed(dictionary: &Dictionary<'_>) -> usize {
    capacity_on(dictionary, 0, 1)
}

/// As [`capacity_needed`], on a storage with pages and words of these sizes
/// ([`Geometry`](super::Geometry)).
pub const fn capacity_on(dictionary: &Dictionary<'_>, page: usize, word: usize) -> usize {
    let mut bytes = layout::header(word);
    let mut i = 0;
    while i < dictionary.len() {
        let row = &dictionary.rows()[i];
        if is_saved(row) {
            let len = row.slot(dictionary.pool()).len as usize;
            bytes += RECORD + if len < MAX_VALUE { len } else { MAX_VALUE };
        }
        i += 1;
    }
    2 * bytes.next_multiple_of(if page > word { page } else { word })
}

/// Returns the [`device`] that wrote the newest set; `None` if no set is complete.
///
/// # Errors
/// [`StorageError`] if the storage cannot be read.
pub fn writer(storage: &mut dyn Storage) -> Result<Option<u32>, StorageError> {
    let mut banks = Banks::NONE;
    Medium::new(storage, &mut banks).survey(0)?;
    Ok(banks.newest.map(|set| set.device))
}

/// Returns the range of the newest set with its header in the storage; `None` if no set is
/// complete. A storage that has these bytes at its start, and is erased after them, has the same
/// saved values.
///
/// # Errors
/// [`StorageError`] if the storage cannot be read.
pub fn newest(storage: &mut dyn Storage) -> Result<Option<Range<usize>>, StorageError> {
    let mut banks = Banks::NONE;
    Medium::new(storage, &mut banks).survey(0)?;
    let place = |set: Set| banks.stays..banks.stays + set.len.get();
    Ok(banks.newest.map(place))
}

/// Number of bytes that a device needs beyond [`capacity_needed`], if LSS stores node ID and bit
/// rate and the device has no objects for them.
pub const OWN_CAPACITY: usize = 2 * 2 * (RECORD + 1);

/// Loads the saved values of the rows that `which` selects into the store.
///
/// The store must contain the defaults before. A saved value is skipped if its object is missing,
/// or cannot have the value (length, limits).
///
/// # Errors
/// [`StorageError`] if the storage cannot be read; some values may be loaded then.
pub fn load(
    storage: &mut dyn Storage,
    store: &mut Store<'_>,
    profile: &StoreProfile,
    which: &dyn Fn(&Row) -> bool,
) -> Result<Loaded, StorageError> {
    let mut banks = Banks::NONE;
    let mut medium = Medium::new(storage, &mut banks);
    medium.survey(device(store.dictionary()))?;
    take_over(&mut medium, store, profile, which)
}

/// The second part of [`load`], for surveyed banks.
pub(crate) fn take_over(
    medium: &mut Medium<'_>,
    store: &mut Store<'_>,
    profile: &StoreProfile,
    which: &dyn Fn(&Row) -> bool,
) -> Result<Loaded, StorageError> {
    let mut skipped = 0;
    let mut records = medium.records();
    loop {
        records.next(medium);
        let Records { key, at, len, .. } = records;
        if key == END {
            break;
        }
        if key >> 8 == u32::from(OWN) {
            continue;
        }
        let row = store
            .dictionary()
            .row_at(Address::new((key >> 8) as u16, key as u8));
        let is_loaded = match row.filter(|row| is_saved(row)) {
            Some(row) if !which(row) || medium.banks.is_withdrawn && !is_life_record(row) => true,
            Some(row) => load_value(medium, store, profile, row, at, len),
            None => false,
        };
        skipped += u32::from(!is_loaded);
    }
    medium.outcome?;
    Ok(match medium.banks.state {
        Loaded::Complete if skipped > 0 => Loaded::Partial {
            skipped: skipped.min(u16::MAX.into()) as u16,
        },
        state => state,
    })
}

/// Loads a saved value into the store. Returns whether the object can have it.
fn load_value(
    medium: &mut Medium<'_>,
    store: &mut Store<'_>,
    profile: &StoreProfile,
    row: &Row,
    at: usize,
    len: usize,
) -> bool {
    // A string is read directly into its place: it may not fit on a small stack.
    if row.is_variable() && len <= MAX_VALUE {
        let Ok(room) = store.room(row, len) else {
            return false;
        };
        medium.read(at, room);
        if medium.outcome.is_err() {
            store.reset_row(row);
        }
        return true;
    }
    let mut number = [0; 8];
    let Some(value) = number.get_mut(..len) else {
        return false;
    };
    medium.read(at, value);
    medium.outcome.is_ok()
        && cob_id::restore(store, row, profile.cob_ids, value)
        && limits::check(store, row, value).is_ok()
        && store.put_row(row, value).is_ok()
}

/// Saves the values that sub-index `sub` (1 to 4) of 1010h covers; the saved values of the other
/// groups stay.
///
/// A `$NODEID` default that was not changed is not saved, so it follows the node ID. Sub-index 0,
/// which no master can write, saves only the operating records ([`is_life_record`]).
///
/// # Errors
/// [`StorageError::Full`] if there is not enough room, before anything is written;
/// [`StorageError::NotWritten`] if the storage does not contain the written bytes; others if the
/// storage fails. The last complete set is still there then.
pub fn save(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    profile: &StoreProfile,
    sub: u8,
) -> Result<(), StorageError> {
    write(
        storage,
        device(store.dictionary()),
        store,
        profile,
        Plan::Save(sub),
    )
}

/// Removes the saved values that sub-index `sub` of 1011h covers, so that the next power-on loads
/// their defaults; the saved values of the other groups stay.
///
/// A record whose object is gone belongs to the group of its index.
///
/// # Errors
/// [`StorageError`] if the storage fails. The last complete set is still there then.
pub fn erase(
    storage: &mut dyn Storage,
    store: &Store<'_>,
    profile: &StoreProfile,
    sub: u8,
) -> Result<(), StorageError> {
    write(
        storage,
        device(store.dictionary()),
        store,
        profile,
        Plan::Restore(sub),
    )
}

#[cfg(test)]
mod tests;
