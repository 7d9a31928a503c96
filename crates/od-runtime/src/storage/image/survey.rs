//! Reading: finds out which banks are complete, which is the newest, and what it contains.

use od_model::{Address, Dictionary};

use super::banks::{Bank, Banks};
use super::layout::{Code, Layout, MAGIC_1, RECORD, VERSION};
use super::medium::Medium;
use crate::storage::StorageError;
use crate::storage::crc::Crc32;

impl Medium<'_> {
    /// Reads both banks to their end, for this device.
    pub(crate) fn survey(&mut self, device: u32) -> Result<(), StorageError> {
        *self.banks = Banks {
            layout: Layout::of(self.storage),
            device,
            ..Banks::NONE
        };
        let size = self.banks.layout.size;
        if size > 0 {
            let (first, second) = (self.look(0), self.look(size));
            self.pair(&first, &second);
        }
        self.outcome
    }

    /// Combines both banks after they were read.
    pub(super) fn pair(&mut self, first: &Bank, second: &Bank) {
        let size = self.banks.layout.size;
        let first_stays = match (first.set, second.set) {
            (Some(_), None) => true,
            (None, Some(_)) => false,
            _ => first.code.is_complete() && second.code.later_than(first.code) == 0,
        };
        if first_stays {
            self.banks.judge(first, second)
        } else {
            self.banks.judge(second, first)
        }
        self.banks.stays = if first_stays { 0 } else { size };
        self.banks.target = size - self.banks.stays;
    }

    /// Returns the node ID and the bit rate that this device saved by [`Plan::Own`](super::Plan::Own).
    pub(crate) fn own(&mut self, device: u32) -> Result<[Option<u8>; 2], StorageError> {
        self.survey(device)?;
        let (mut own, mut records) = ([None; 2], self.records());
        loop {
            records.next(self);
            // Index 0: the key is the sub-index.
            let place = (records.key as usize).wrapping_sub(1);
            match own.get_mut(place) {
                _ if records.key == END => break,
                Some(own) if records.len == 1 => {
                    let mut value = [0];
                    self.read(records.at, &mut value);
                    *own = Some(value[0]);
                }
                _ => {}
            }
        }
        self.outcome.map(|()| own)
    }

    /// Reads the content of the bank from here on.
    fn look(&mut self, start: usize) -> Bank {
        let Layout { word, size, .. } = self.banks.layout;
        let mut bank = self.head(start);
        if bank.code.is_complete() {
            bank.set = self.content(start);
        }
        let used = bank.used(word);
        bank.is_clean &= bank.code == Code::GIVEN_UP || self.is_blank(start + used, start + size);
        bank
    }

    /// Reads the codes of the bank from here on.
    pub(super) fn head(&mut self, start: usize) -> Bank {
        let word = self.banks.layout.word;
        let ((code, is_exact), (mark, is_right)) = (self.code(start), self.code(start + word));
        let mut magic = [0; MAGIC_1.len()];
        self.read(start, &mut magic);
        Bank {
            code,
            mark,
            set: None,
            is_clean: is_exact && is_right,
            is_old: magic == MAGIC_1,
        }
    }

    /// The records of the newest set; none if it belongs to another device.
    pub(super) fn records(&self) -> Records {
        let banks = &self.banks;
        let header = banks.layout.header;
        let own = banks.newest.filter(|set| set.device == banks.device);
        Records {
            key: 0,
            at: banks.stays + header,
            len: 0,
            end: banks.stays + own.map_or(header, |set| set.len.get()),
        }
    }
}

/// Number by which a saved set identifies its device: version of the layout, vendor-ID and product
/// code (1018h). The revision number does not count, since a newer firmware changes it.
pub const fn device(dictionary: &Dictionary<'_>) -> u32 {
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

/// The records of a bank, in order; the present record is in its fields.
#[derive(Clone, Copy, Debug)]
pub(super) struct Records {
    /// Its address as a number; [`END`] after the last record.
    pub(super) key: u32,
    /// Offset of its value.
    pub(super) at: usize,
    pub(super) len: usize,
    end: usize,
}

impl Records {
    /// The records of no set.
    pub(super) const NONE: Self = Self {
        key: END,
        at: 0,
        len: 0,
        end: 0,
    };
}

/// A key greater than the last address.
pub(super) const END: u32 = u32::MAX;

impl Records {
    /// Goes to the next record, or to the [`END`] if the rest is not a record.
    pub(super) fn next(&mut self, medium: &mut Medium<'_>) {
        self.key = END;
        let start = self.at + self.len;
        if self.end - start < RECORD {
            return;
        }
        let mut head = [0; RECORD];
        medium.read(start, &mut head);
        let [index_low, index_high, sub, len_low, len_high] = head;
        let (at, len) = (
            start + RECORD,
            u16::from_le_bytes([len_low, len_high]).into(),
        );
        if self.end - at >= len {
            self.key = u32::from_le_bytes([sub, index_low, index_high, 0]);
            (self.at, self.len) = (at, len);
        }
    }
}
