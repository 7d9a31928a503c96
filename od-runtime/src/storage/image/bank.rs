//! Reading: which banks are whole, which is the newest, and what is in it.

use od_model::Address;

use super::layout::{HEADER, MAGIC, RECORD, REPLACED, VERSION};
use crate::storage::crc::Crc32;
use crate::storage::{Storage, StorageError};

/// A whole bank.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bank {
    /// Offset of its header.
    pub(super) start: usize,
    /// Bytes of records.
    len: usize,
    pub(super) sequence: u32,
    /// A save was to replace it. As the newest set it means that the save was cut.
    pub(super) replaced: bool,
}

/// State of both banks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Banks {
    pub(super) newest: Option<Bank>,
    /// Offset of the bank for the next set.
    pub(super) target: usize,
    /// Bytes of a bank.
    pub(super) size: usize,
    /// A bank holds something other than a set.
    pub(super) damaged: bool,
    /// The damaged one was written after the newest whole one, or may have been.
    pub(super) lost_newer: bool,
}

enum Found {
    /// Nothing, or the remains of a save that was cut.
    Empty,
    Damaged {
        sequence: u32,
    },
    Whole(Bank),
}

impl Banks {
    /// Reads both banks to their end.
    pub(super) fn survey(storage: &mut dyn Storage) -> Result<Self, StorageError> {
        let size = storage.capacity() / 2;
        let mut banks = Self {
            newest: None,
            target: 0,
            size,
            damaged: false,
            lost_newer: false,
        };
        if size < HEADER {
            return Ok(banks);
        }
        let found = [look(storage, 0, size)?, look(storage, size, size)?];
        for found in &found {
            if let Found::Whole(bank) = found {
                let newer = |than: Bank| bank.sequence.wrapping_sub(than.sequence) as i32 > 0;
                if banks.newest.is_none_or(newer) {
                    banks.newest = Some(*bank);
                }
            }
        }
        for found in &found {
            if let Found::Damaged { sequence } = found {
                banks.damaged = true;
                banks.lost_newer |= banks
                    .newest
                    .is_some_and(|newest| newest.sequence.wrapping_sub(1) != *sequence);
            }
        }
        banks.target = match (banks.newest, &found) {
            (Some(Bank { start: 0, .. }), _) => size,
            (Some(_), _) => 0,
            // Nothing is overwritten while there is room that holds nothing.
            (None, [Found::Damaged { .. }, Found::Empty]) => size,
            (None, _) => 0,
        };
        Ok(banks)
    }

    /// Whether the last save was interrupted, on a device that loads the factory values then.
    pub(super) fn is_cut(&self) -> bool {
        self.newest.is_some_and(|bank| bank.replaced)
    }

    /// The records of the newest set.
    pub(super) fn records(&self) -> Records {
        self.newest.map_or(Records { at: 0, end: 0 }, Records::new)
    }

    /// The sequence number of the next set.
    pub(super) fn next_sequence(&self) -> u32 {
        self.newest.map_or(1, |bank| bank.sequence.wrapping_add(1))
    }
}

fn look(storage: &mut dyn Storage, start: usize, size: usize) -> Result<Found, StorageError> {
    let mut header = [0; HEADER];
    storage.read(start, &mut header)?;
    let word = |at: usize| {
        u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]])
    };
    let sequence = word(8);
    let damaged = Ok(Found::Damaged { sequence });
    let replaced = header[0] == REPLACED;
    if header[1..4] != MAGIC[1..] || !(replaced || header[0] == MAGIC[0]) {
        // What is there while the magic is written or taken away.
        let empty = |(byte, magic): (&u8, &u8)| matches!(byte, 0 | 0xFF) || byte == magic;
        let empty = header.iter().zip(&MAGIC).all(empty);
        return if empty { Ok(Found::Empty) } else { damaged };
    }
    let len = word(12) as usize;
    if word(4) != u32::from(VERSION) || len > size - HEADER {
        return damaged;
    }
    let mut crc = Crc32::new();
    crc.update(&header[4..16]);
    in_chunks(storage, start + HEADER, len, |_, chunk| {
        crc.update(chunk);
        Ok(())
    })?;
    if crc.finish() != word(16) {
        return damaged;
    }
    let bank = Bank {
        start,
        len,
        sequence,
        replaced,
    };
    let mut records = Records::new(bank);
    let mut last = None;
    while let Some(record) = records.next(storage)? {
        if last >= Some(record.address) {
            return damaged;
        }
        last = Some(record.address);
    }
    Ok(if records.at == records.end {
        Found::Whole(bank)
    } else {
        Found::Damaged { sequence }
    })
}

/// Reads `len` bytes from `start` on, a piece at a time.
pub(super) fn in_chunks(
    storage: &mut dyn Storage,
    start: usize,
    len: usize,
    mut each: impl FnMut(&mut dyn Storage, &[u8]) -> Result<(), StorageError>,
) -> Result<(), StorageError> {
    let mut chunk = [0; 64];
    for at in (0..len).step_by(chunk.len()) {
        let part = &mut chunk[..(len - at).min(64)];
        storage.read(start + at, part)?;
        each(storage, part)?;
    }
    Ok(())
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
    fn new(bank: Bank) -> Self {
        let at = bank.start + HEADER;
        Self {
            at,
            end: at + bank.len,
        }
    }

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
