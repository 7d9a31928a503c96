//! Reading: which banks are whole, which is the newest, and what is in it.

use od_model::{Address, Dictionary};

use super::layout::{
    Code, ERASED, FIELDS, Layout, MAGIC_1, MAX_HEADER, RECORD, VERSION, decode, in_chunks, is_blank,
};
use super::loaded::Loaded;
use crate::storage::crc::Crc32;
use crate::storage::{Storage, StorageError};

/// Content of a bank.
struct Bank {
    /// Offset of its header.
    start: usize,
    /// Commit word.
    code: Code,
    /// The word after it: a save that replaces the set began.
    mark: Code,
    /// Its set, if it is whole.
    set: Option<Set>,
    /// Every bit is as a save left it.
    is_clean: bool,
    /// Version 1 of this layout.
    is_old: bool,
}

/// A whole set.
#[derive(Clone, Copy)]
pub(super) struct Set {
    /// [`device`] that wrote it.
    pub(super) device: u32,
    /// Bytes of records.
    pub(super) len: usize,
}

/// State of both banks.
pub(super) struct Banks {
    pub(super) layout: Layout,
    /// The bank that stays with the next save: that of the newest set, if there is one.
    pub(super) stays: usize,
    /// Bytes of records in it; none if it is another device's.
    len: usize,
    /// The bank of the next set.
    pub(super) target: usize,
    /// The commit word of the next set.
    pub(super) next: Code,
    /// The device.
    pub(super) device: u32,
    /// The newest set, of whatever device.
    pub(super) newest: Option<Set>,
    /// The set that a start loads, whether or not its records fit.
    pub(super) state: Loaded,
    /// The newest set does not count, because a later save was interrupted on a device that loads
    /// the factory values then; the operating records in it do.
    pub(super) is_withdrawn: bool,
}

impl Banks {
    /// Reads both banks to their end.
    pub(super) fn survey(storage: &mut dyn Storage, device: u32) -> Result<Self, StorageError> {
        let layout = Layout::of(storage);
        let first = look(storage, &layout, 0)?;
        let second = look(storage, &layout, layout.size)?;
        let first_stays = match (first.set, second.set) {
            (Some(_), None) => true,
            (None, Some(_)) => false,
            _ => first.code.is_complete() && second.code.later_than(first.code) == 0,
        };
        let (stays, target) = match first_stays {
            true => (&first, &second),
            false => (&second, &first),
        };
        let was_withdrawn = stays.mark == Code::WITHDRAWN;
        // A save began that was not completed.
        let is_interrupted =
            (was_withdrawn || stays.mark == Code::REPLACED) && target.code != Code::GIVEN_UP;
        // A set is damaged that is later than the newest.
        let lost = match target.code {
            // Flash may have any content where power went.
            Code::UNCLEAR => (layout.page == 0 && stays.mark == Code::REPLACED).into(),
            code => code.later_than(stays.code),
        };
        let is_withdrawn = was_withdrawn
            && match lost {
                0 => is_interrupted,
                later => later == 2,
            };
        let is_clean = stays.is_clean && target.is_clean;
        let state = match stays.set {
            Some(set) if set.device != device => Loaded::Foreign,
            Some(_) if lost > 0 && is_withdrawn => Loaded::Damaged,
            Some(_) if lost > 0 => Loaded::Older,
            Some(_) if is_interrupted => Loaded::Cut {
                factory: was_withdrawn,
            },
            Some(_) if is_clean => Loaded::Complete,
            Some(_) => Loaded::Flawed,
            None if stays.code.is_complete() => Loaded::Damaged,
            None if stays.is_old || target.is_old => Loaded::Foreign,
            None if is_interrupted => Loaded::Cut { factory: true },
            None if is_clean => Loaded::Blank,
            None => Loaded::Damaged,
        };
        let own = stays.set.filter(|set| set.device == device);
        let next = match stays.code.is_complete() {
            true => stays.code.plus(if is_withdrawn { 2 } else { 1 }),
            false => Code::FIRST,
        };
        Ok(Self {
            layout,
            stays: stays.start,
            len: own.map_or(0, |set| set.len),
            target: target.start,
            next,
            device,
            newest: stays.set,
            state,
            is_withdrawn,
        })
    }

    /// The records of the newest set.
    pub(super) fn records(&self) -> Records {
        let at = self.stays + self.layout.header();
        let end = at + self.len;
        Records { at, end }
    }
}

/// Returns the number by which a set knows its device: version of the layout, vendor-ID and product
/// code (1018h).
pub(super) fn device(dictionary: &Dictionary<'_>) -> u32 {
    let mut crc = Crc32::new();
    crc.update(&[VERSION]);
    for sub in 1..=2 {
        let row = dictionary.row_of(Address::new(0x1018, sub));
        let number = row.map_or(0, |row| row.default(dictionary.pool(), 0));
        crc.update(&(number as u32).to_le_bytes());
    }
    crc.finish()
}

fn look(storage: &mut dyn Storage, layout: &Layout, start: usize) -> Result<Bank, StorageError> {
    let mut bank = Bank {
        start,
        code: Code::ERASED,
        mark: Code::ERASED,
        set: None,
        is_clean: true,
        is_old: false,
    };
    if layout.size == 0 {
        return Ok(bank);
    }
    let mut header = [0; MAX_HEADER];
    let header = header.get_mut(..layout.header()).unwrap_or_default();
    storage.read(start, header)?;
    bank.is_old = header.starts_with(MAGIC_1);
    (bank.code, bank.mark, bank.is_clean) = decode(header, layout.word);
    if bank.code.is_complete() {
        bank.set = content(storage, layout, start)?;
    }
    let used = match bank.set {
        Some(set) => layout.header() + set.len,
        None => 2 * layout.word,
    };
    bank.is_clean &=
        bank.code == Code::GIVEN_UP || is_blank(storage, start + used, layout.size - used)?;
    Ok(bank)
}

/// Returns the set of a bank, if fields and records are whole.
pub(super) fn content(
    storage: &mut dyn Storage,
    layout: &Layout,
    bank: usize,
) -> Result<Option<Set>, StorageError> {
    let mut fields = [0; MAX_HEADER];
    let len = layout.header() - 2 * layout.word;
    let read = fields.get_mut(..len).unwrap_or_default();
    storage.read(bank + 2 * layout.word, read)?;
    let number = |at: usize| {
        u32::from_le_bytes([fields[at], fields[at + 1], fields[at + 2], fields[at + 3]])
    };
    let start = bank + layout.header();
    let mut rest = fields.iter().take(len).skip(FIELDS);
    let len = number(4) as usize;
    if len > layout.size - layout.header() || rest.any(|byte| *byte != ERASED) {
        return Ok(None);
    }
    let mut crc = Crc32::new();
    crc.update(&fields[..8]);
    in_chunks(storage, start, len, |_, chunk| {
        crc.update(chunk);
        Ok(())
    })?;
    if crc.finish() != number(8) {
        return Ok(None);
    }
    let device = number(0);
    Ok(Some(Set { device, len }))
}

/// One saved value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    pub(super) address: Address,
    /// Offset of its value.
    pub(super) at: usize,
    pub(super) len: usize,
}

/// The records of a bank, in order.
pub(super) struct Records {
    at: usize,
    end: usize,
}

impl Records {
    /// `None` at the end, and if the rest is not a record.
    pub(super) fn next(
        &mut self,
        storage: &mut dyn Storage,
    ) -> Result<Option<Record>, StorageError> {
        if self.end - self.at < RECORD {
            return Ok(None);
        }
        let mut head = [0; RECORD];
        storage.read(self.at, &mut head)?;
        let [index_low, index_high, sub, len_low, len_high] = head;
        let record = Record {
            address: Address::new(u16::from_le_bytes([index_low, index_high]), sub),
            at: self.at + RECORD,
            len: usize::from(u16::from_le_bytes([len_low, len_high])),
        };
        if self.end - record.at < record.len {
            return Ok(None);
        }
        self.at = record.at + record.len;
        Ok(Some(record))
    }
}
