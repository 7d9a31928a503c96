//! A storage while an image is read or written, with the state of its banks and the first failure.

use core::num::NonZeroUsize;

use super::banks::{Banks, Set};
use super::layout::{Code, ERASED, FIELDS, Layout, MAX_WORD};
use crate::storage::crc::Crc32;
use crate::storage::{Storage, StorageError};

/// A storage that does nothing after its first failure.
pub(crate) struct Medium<'m> {
    pub(super) storage: &'m mut dyn Storage,
    pub(super) banks: &'m mut Banks,
    /// The first failure.
    pub(super) outcome: Result<(), StorageError>,
    /// Bytes that are being moved, up to the longest word.
    pub(super) buffer: [u8; MAX_WORD],
}

impl<'m> Medium<'m> {
    pub(crate) fn new(storage: &'m mut dyn Storage, banks: &'m mut Banks) -> Self {
        Self {
            storage,
            banks,
            outcome: Ok(()),
            buffer: [0; MAX_WORD],
        }
    }

    /// Notes a failure that the storage did not report.
    pub(super) fn fail(&mut self, error: StorageError) {
        self.outcome = self.outcome.and(Err(error));
    }

    /// Fills `to`; after a failure `to` stays unchanged.
    pub(super) fn read(&mut self, at: usize, to: &mut [u8]) {
        if self.outcome.is_ok() {
            self.outcome = self.storage.read(at, to);
        }
    }

    /// Reads into the buffer, up to its length.
    fn fetch(&mut self, at: usize, len: usize) -> &[u8] {
        let part = self.buffer.get_mut(..len).unwrap_or_default();
        if self.outcome.is_ok() {
            self.outcome = self.storage.read(at, part);
        }
        part
    }

    /// Writes this number of bytes of the buffer.
    pub(super) fn write(&mut self, at: usize, len: usize) {
        if self.outcome.is_ok() {
            let part = self.buffer.get(..len).unwrap_or_default();
            self.outcome = self.storage.write(at, part);
        }
    }

    /// Writes one byte up to 32 times.
    fn fill(&mut self, at: usize, len: usize, byte: u8) {
        self.buffer = [byte; MAX_WORD];
        self.write(at, len);
    }

    pub(super) fn flush(&mut self) {
        if self.outcome.is_ok() {
            self.outcome = self.storage.flush();
        }
    }

    /// Returns whether all bytes of a range are this one.
    pub(super) fn holds(&mut self, mut at: usize, end: usize, byte: u8) -> bool {
        let word = [byte; 4];
        self.buffer = [byte; MAX_WORD];
        while at < end {
            self.fetch(at, (end - at).min(MAX_WORD));
            // Most of a bank is erased, so most of the time of a start is spent here.
            if self.buffer.as_chunks().0.iter().any(|other| *other != word) {
                return false;
            }
            at += MAX_WORD;
        }
        true
    }

    /// Returns whether the range was never written: all bytes are FFh, or all are 0.
    pub(super) fn is_blank(&mut self, at: usize, end: usize) -> bool {
        self.holds(at, end, ERASED) || self.holds(at, end, 0)
    }

    /// Prepares a bank for a set of `len` bytes with its header.
    pub(super) fn clear(&mut self, bank: usize, len: usize) {
        let Layout { page, word, .. } = self.banks.layout;
        if page == 0 {
            self.stamp(bank, Code::ERASED);
            self.stamp(bank + word, Code::ERASED);
            return;
        }
        let mut at = 0;
        while at < self.banks.layout.size {
            // Pages after the set are usually erased already.
            let start = bank + at;
            if (at < len || !self.is_blank(start, start + page)) && self.outcome.is_ok() {
                self.outcome = self.storage.erase(start);
            }
            at += page;
        }
        self.flush();
    }

    /// Clears the bytes of older sets after the records; flash is erased there already.
    pub(super) fn wipe(&mut self, mut at: usize, end: usize) {
        while self.banks.layout.page == 0 && at < end {
            let part = (end - at).min(MAX_WORD);
            // A new storage may be all 0; a part of it would look like a set that was removed.
            if !self.holds(at, at + part, ERASED) {
                self.fill(at, part, ERASED);
            }
            at += part;
        }
    }

    /// Reads the code in the word at `at`; `false` if a bit is wrong.
    pub(super) fn code(&mut self, at: usize) -> (Code, bool) {
        Code::read(self.fetch(at, self.banks.layout.word))
    }

    /// Writes a code into the word at `at`, and reads it back.
    pub(super) fn stamp(&mut self, at: usize, code: Code) {
        let (byte, end) = (code.byte(), at + self.banks.layout.word);
        // A word of flash is written once.
        if !self.holds(at, end, byte)
            && (self.banks.layout.page == 0 || self.holds(at, end, ERASED))
        {
            self.fill(at, self.banks.layout.word, byte);
            self.flush();
        }
        if !self.holds(at, end, byte) {
            self.fail(StorageError::NotWritten);
        }
    }

    /// Marks the set in a bank as incomplete. Power did not fail, so the set before it is valid, if
    /// the storage still works.
    pub(super) fn give_up(&mut self, bank: usize) {
        let outcome = core::mem::replace(&mut self.outcome, Ok(()));
        self.stamp(bank, Code::GIVEN_UP);
        self.outcome = outcome;
    }

    /// Returns the set of a bank, if its fields and records are complete.
    pub(super) fn content(&mut self, bank: usize) -> Option<Set> {
        let mut content = self.open(bank)?;
        content.go_on(self, usize::MAX);
        content.set(self)
    }

    /// Returns the records of a bank, if its fields are possible.
    pub(super) fn open(&mut self, bank: usize) -> Option<Content> {
        let Layout {
            word, header, size, ..
        } = self.banks.layout;
        let (mut fields, at) = ([[0; 4]; 3], bank + 2 * word);
        self.read(at, fields.as_flattened_mut());
        let [device, len, sum] = fields.map(u32::from_le_bytes);
        let (records, len) = (bank + header, len as usize);
        if len > size - header || !self.holds(at + FIELDS, records, ERASED) {
            return None;
        }
        let mut crc = Crc32::new();
        crc.update(fields[..2].as_flattened());
        Some(Content {
            device,
            len,
            sum,
            crc,
            at: records,
            end: records + len,
        })
    }
}

/// The records of a bank while they are read.
#[derive(Clone, Debug)]
pub(super) struct Content {
    device: u32,
    len: usize,
    sum: u32,
    crc: Crc32,
    at: usize,
    end: usize,
}

impl Content {
    /// Reads this number of bytes, in whole buffers. Returns whether these were the last bytes.
    pub(super) fn go_on(&mut self, medium: &mut Medium<'_>, most: usize) -> bool {
        let end = self.at + most.min(self.end - self.at);
        while self.at < end {
            let part = medium.fetch(self.at, (self.end - self.at).min(MAX_WORD));
            self.crc.update(part);
            self.at += MAX_WORD;
        }
        self.at >= self.end
    }

    /// Returns the set, if its checksum is right.
    pub(super) fn set(self, medium: &Medium<'_>) -> Option<Set> {
        let len = NonZeroUsize::new(medium.banks.layout.header + self.len)?;
        let device = self.device;
        (self.crc.finish() == self.sum).then_some(Set { device, len })
    }
}
