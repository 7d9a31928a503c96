//! State of the banks: which of them are complete, and which is the newest.

use core::num::NonZeroUsize;

use super::layout::{Code, Layout};

/// Content of the storage when it is loaded.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Loaded {
    /// No set, or no set of this device: the values are the defaults.
    Blank,
    /// The set of the last save.
    Complete,
    /// The set of the last save. Some of its records do not fit an object of this dictionary and
    /// were left out.
    Partial {
        /// Number of records that were left out.
        skipped: u16,
    },
    /// The set of the last save. Bits of the storage outside this set have changed.
    Flawed,
    /// The last set is damaged; the values are those of the save before it.
    Older,
    /// A save was interrupted.
    Cut {
        /// `true`: the values are the defaults, except the operating records; `false`: the values
        /// are those that were saved before.
        factory: bool,
    },
    /// Another device, or another version of odkit, wrote the content: the values are the defaults.
    Foreign,
    /// The content cannot be read: the values are the defaults.
    Damaged,
}

/// A complete set.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Set {
    /// [`device`](super::device) that wrote it.
    pub(super) device: u32,
    /// Bytes of header and records.
    pub(super) len: NonZeroUsize,
}

/// Content of a bank.
#[derive(Clone, Debug)]
pub(super) struct Bank {
    /// Commit word.
    pub(super) code: Code,
    /// The word after it: a save that replaces the set began.
    pub(super) mark: Code,
    /// Its set, if it is complete.
    pub(super) set: Option<Set>,
    /// Every bit is as the save wrote it.
    pub(super) is_clean: bool,
    /// Version 1 of this layout.
    pub(super) is_old: bool,
}

impl Bank {
    /// Number of bytes of codes and set.
    pub(super) fn used(&self, word: usize) -> usize {
        self.set.map_or(2 * word, |set| set.len.get())
    }
}

/// State of both banks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Banks {
    pub(super) layout: Layout,
    /// The bank that the next save does not write: that of the newest set, if there is one.
    pub(super) stays: usize,
    /// The bank of the next set.
    pub(super) target: usize,
    /// The device.
    pub(super) device: u32,
    /// The newest set, of any device.
    pub(super) newest: Option<Set>,
    /// Result of the start: the set that it loads, before its records are checked.
    pub(super) state: Loaded,
    /// Commit word of the next set; [erased](Code::ERASED): no set follows.
    pub(super) next: Code,
    /// The newest set is not loaded, because a later save was interrupted on a device that loads
    /// the factory values in this case. Its operating records are loaded.
    pub(super) is_withdrawn: bool,
}

impl Banks {
    /// Banks that were not read yet: all zeros.
    pub(crate) const NONE: Self = Self {
        layout: Layout::NONE,
        stays: 0,
        target: 0,
        device: 0,
        newest: None,
        state: Loaded::Blank,
        next: Code::ERASED,
        is_withdrawn: false,
    };

    /// Returns whether a next set is written except its commit word.
    pub(crate) fn is_some(&self) -> bool {
        self.next != Code::ERASED
    }

    /// Combines the states of two banks.
    pub(super) fn judge(&mut self, stays: &Bank, target: &Bank) {
        let was_withdrawn = stays.mark == Code::WITHDRAWN;
        // A save began and was not completed.
        let is_interrupted =
            (was_withdrawn || stays.mark == Code::REPLACED) && target.code != Code::GIVEN_UP;
        // A set later than the newest is damaged.
        let lost = match target.code {
            // Flash may have any content where a write was interrupted.
            Code::UNCLEAR => (self.layout.page == 0 && stays.mark == Code::REPLACED).into(),
            code => code.later_than(stays.code),
        };
        let is_withdrawn = was_withdrawn
            && match lost {
                0 => is_interrupted,
                later => later == 2,
            };
        let is_clean = stays.is_clean && target.is_clean;
        self.state = match stays.set {
            Some(set) if set.device != self.device => Loaded::Foreign,
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
        self.next = if stays.code.is_complete() {
            stays.code.plus(if is_withdrawn { 2 } else { 1 })
        } else {
            Code::FIRST
        };
        self.newest = stays.set;
        self.is_withdrawn = is_withdrawn;
    }
}
