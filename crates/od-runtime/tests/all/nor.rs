//! NOR flash that panics on everything that a data sheet forbids.
#![allow(dead_code, unreachable_pub)] // each test file uses its own part

use od_runtime::storage::{Geometry, Storage, StorageError};

/// Flash in memory, whose power can be cut between and within its steps.
#[derive(Clone)]
pub struct Nor {
    pub bytes: Vec<u8>,
    page: usize,
    word: usize,
    /// Words that were written since their page was erased.
    written: Vec<bool>,
    /// Number of steps (a word, a page) before power fails.
    left: Option<usize>,
    pub is_cut: bool,
    /// The word at this offset keeps its content.
    pub stuck: Option<usize>,
    /// Number of erased pages.
    pub erases: usize,
    random: u64,
}

impl Nor {
    /// Flash of whole pages, erased once.
    pub fn new(capacity: usize, page: usize, word: usize) -> Self {
        assert!(capacity.is_multiple_of(page) && page.is_multiple_of(word));
        Self {
            bytes: vec![0xFF; capacity],
            page,
            word,
            written: vec![false; capacity / word],
            left: None,
            is_cut: false,
            stuck: None,
            erases: 0,
            random: 0x9E37_79B9_7F4A_7C15,
        }
    }

    /// Cuts the power in the step after `steps` others; `seed` decides the content that remains.
    pub fn cut_after(&mut self, steps: usize, seed: u64) {
        self.left = Some(steps);
        self.random ^= (seed + 1).wrapping_mul(0x2545_F491_4F6C_DD1D);
    }

    pub fn restore_power(&mut self) {
        self.left = None;
        self.is_cut = false;
    }

    /// A random byte.
    fn byte(&mut self) -> u8 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 32) as u8
    }

    /// Returns whether power fails in this step.
    fn goes(&mut self) -> bool {
        match &mut self.left {
            Some(0) => self.is_cut = true,
            Some(left) => *left -= 1,
            None => {}
        }
        self.is_cut
    }
}

impl Storage for Nor {
    fn capacity(&self) -> usize {
        self.bytes.len()
    }

    fn geometry(&self) -> Geometry {
        Geometry {
            capacity: self.bytes.len(),
            page: self.page,
            word: self.word,
        }
    }

    fn read(&mut self, offset: usize, to: &mut [u8]) -> Result<(), StorageError> {
        if self.is_cut {
            return Err(StorageError::PowerCut);
        }
        to.copy_from_slice(&self.bytes[offset..][..to.len()]);
        Ok(())
    }

    fn write(&mut self, offset: usize, bytes: &[u8]) -> Result<(), StorageError> {
        if self.is_cut {
            return Err(StorageError::PowerCut);
        }
        assert!(bytes.len() <= 64, "{} bytes in one call", bytes.len());
        assert!(
            offset.is_multiple_of(self.word) && bytes.len().is_multiple_of(self.word),
            "{} bytes at {offset} are not whole words",
            bytes.len()
        );
        for (at, word) in (offset..).step_by(self.word).zip(bytes.chunks(self.word)) {
            let number = at / self.word;
            assert!(!self.written[number], "word {number} is written twice");
            self.written[number] = true;
            let goes = self.goes();
            for (at, byte) in (at..).zip(word) {
                assert_eq!(
                    self.bytes[at] & byte,
                    *byte,
                    "a bit is set without an erasure"
                );
                // A power failure leaves some bits of a word written.
                let kept = if goes { self.byte() } else { 0 };
                if self.stuck != Some(number * self.word) {
                    self.bytes[at] &= byte | kept;
                }
            }
            if goes {
                // A program cannot detect a failure that changed nothing.
                self.written[number] = self.bytes[at..][..self.word].iter().any(|byte| *byte < 255);
                return Err(StorageError::PowerCut);
            }
        }
        Ok(())
    }

    fn erase(&mut self, offset: usize) -> Result<(), StorageError> {
        if self.is_cut {
            return Err(StorageError::PowerCut);
        }
        assert!(offset.is_multiple_of(self.page), "{offset} is not a page");
        let goes = self.goes();
        self.erases += 1;
        for at in offset..offset + self.page {
            // A power failure leaves some bits of a page set.
            self.bytes[at] |= if goes {
                self.byte() & self.byte()
            } else {
                0xFF
            };
        }
        let words = offset / self.word..(offset + self.page) / self.word;
        self.written[words].fill(goes);
        if goes {
            Err(StorageError::PowerCut)
        } else {
            Ok(())
        }
    }
}
