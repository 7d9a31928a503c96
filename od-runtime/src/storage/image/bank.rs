//! Reading: which banks are whole, which is the newest, and what is in it.

use od_model::{Address, Dictionary};

use super::layout::{Code, ERASED, FIELDS, Layout, MAGIC_1, MAX_WORD, RECORD, VERSION, is_blank};
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
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Set {
    /// [`device`] that wrote it.
    pub(super) device: u32,
    /// Bytes of records.
    pub(super) len: usize,
}

/// State of both banks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Banks {
    pub(super) layout: Layout,
    /// The bank that stays with the next save: that of the newest set, if there is one.
    pub(super) stays: usize,
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
    /// Banks that nobody has looked at: all zeros.
    pub(crate) const NONE: Self = Self {
        layout: Layout::NONE,
        stays: 0,
        target: 0,
        next: Code::ERASED,
        device: 0,
        newest: None,
        state: Loaded::Blank,
        is_withdrawn: false,
    };

    /// Whether there is a next set, which is written but for its commit word.
    pub(crate) const fn is_some(&self) -> bool {
        self.layout.size > 0
    }

    /// Reads both banks to their end, for this device. In place: these are many bytes for a small stack.
    #[inline(never)]
    pub(crate) fn survey(
        &mut self,
        storage: &mut dyn Storage,
        device: u32,
    ) -> Result<(), StorageError> {
        let layout = Layout::of(storage);
        let (mut first, mut second) = (Bank::at(0), Bank::at(layout.size));
        first.look(storage, &layout)?;
        second.look(storage, &layout)?;
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
        self.next = match stays.code.is_complete() {
            true => stays.code.plus(if is_withdrawn { 2 } else { 1 }),
            false => Code::FIRST,
        };
        self.layout = layout;
        self.stays = stays.start;
        self.device = device;
        self.target = target.start;
        self.newest = stays.set;
        self.state = state;
        self.is_withdrawn = is_withdrawn;
        Ok(())
    }

    /// The records of the newest set; none if it is another device's.
    #[inline(never)]
    pub(super) fn records(&self) -> Records {
        let start = self.stays + self.layout.header();
        let own = self.newest.filter(|set| set.device == self.device);
        Records {
            record: Record {
                address: Address::new(0, 0),
                at: start,
                len: 0,
            },
            end: start + own.map_or(0, |set| set.len),
        }
    }
}

/// Returns the number by which a set knows its device: version of the layout, vendor-ID and product
/// code (1018h).
pub(super) const fn device(dictionary: &Dictionary<'_>) -> u32 {
    let mut crc = Crc32::new().after(&[VERSION]);
    let mut sub = 1;
    while sub <= 2 {
        let mut number = 0;
        let mut rest = dictionary.rows();
        while let [row, others @ ..] = rest {
            if row.key() == Address::new(0x1018, sub).key() {
                number = row.default(dictionary.pool(), 0);
            }
            rest = others;
        }
        crc = crc.after(&(number as u32).to_le_bytes());
        sub += 1;
    }
    crc.finish()
}

impl Bank {
    /// A bank whose content is not known.
    const fn at(start: usize) -> Self {
        Self {
            start,
            code: Code::ERASED,
            mark: Code::ERASED,
            set: None,
            is_clean: true,
            is_old: false,
        }
    }

    #[inline(never)]
    fn look(&mut self, storage: &mut dyn Storage, layout: &Layout) -> Result<(), StorageError> {
        if layout.size == 0 {
            return Ok(());
        }
        self.decode(storage, layout)?;
        if self.code.is_complete() {
            self.set = content(storage, layout, self.start)?;
        }
        let used = match self.set {
            Some(set) => layout.header() + set.len,
            None => 2 * layout.word,
        };
        self.is_clean &= self.code == Code::GIVEN_UP
            || is_blank(storage, self.start + used, layout.size - used)?;
        Ok(())
    }

    /// Reads commit word and mark.
    #[inline(always)]
    fn decode(&mut self, storage: &mut dyn Storage, layout: &Layout) -> Result<(), StorageError> {
        let (is_exact, is_right);
        (self.code, is_exact) = layout.code(storage, self.start)?;
        (self.mark, is_right) = layout.code(storage, self.start + layout.word)?;
        self.is_clean = is_exact && is_right;
        let mut magic = [0; MAGIC_1.len()];
        storage.read(self.start, &mut magic)?;
        self.is_old = magic == MAGIC_1;
        Ok(())
    }
}

/// Returns the set of a bank, if fields and records are whole.
#[inline(never)]
pub(super) fn content(
    storage: &mut dyn Storage,
    layout: &Layout,
    bank: usize,
) -> Result<Option<Set>, StorageError> {
    let mut fields = [0; MAX_WORD];
    let len = layout.header() - 2 * layout.word;
    let read = fields.get_mut(..len).unwrap_or_default();
    storage.read(bank + 2 * layout.word, read)?;
    let number = |at: usize| {
        u32::from_le_bytes([fields[at], fields[at + 1], fields[at + 2], fields[at + 3]])
    };
    let (device, size, sum) = (number(0), number(4), number(8));
    let mut rest = fields.iter().take(len).skip(FIELDS);
    if size as usize > layout.size - layout.header() || rest.any(|byte| *byte != ERASED) {
        return Ok(None);
    }
    let (mut crc, mut at, len) = (Crc32::new(), bank + layout.header(), size as usize);
    crc.update(&fields[..8]);
    let end = at + len;
    while at < end {
        let part = (end - at).min(fields.len());
        let part = fields.get_mut(..part).unwrap_or_default();
        storage.read(at, part)?;
        crc.update(part);
        at += part.len();
    }
    Ok((crc.finish() == sum).then_some(Set { device, len }))
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
    /// The one that [`next`](Self::next) has found.
    pub(super) record: Record,
    end: usize,
}

impl Records {
    /// Goes to the next record. `false` at the end, and if the rest is not a record.
    #[inline(never)]
    pub(super) fn next(&mut self, storage: &mut dyn Storage) -> Result<bool, StorageError> {
        let start = self.record.at + self.record.len;
        if self.end - start < RECORD {
            return Ok(false);
        }
        let mut head = [0; RECORD];
        storage.read(start, &mut head)?;
        let [index_low, index_high, sub, len_low, len_high] = head;
        let (at, len) = (start + RECORD, u16::from_le_bytes([len_low, len_high]));
        if self.end - at < len.into() {
            return Ok(false);
        }
        self.record = Record {
            address: Address::new(u16::from_le_bytes([index_low, index_high]), sub),
            at,
            len: len.into(),
        };
        Ok(true)
    }
}
