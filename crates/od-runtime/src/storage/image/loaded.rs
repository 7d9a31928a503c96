//! Outcome of a load.

/// Content of the storage at the time of a load.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Loaded {
    /// Nothing yet, or nothing of this device: the values keep their defaults.
    Blank,
    /// The last set that was saved.
    Complete,
    /// The last set that was saved; these many of its records fit no object of this
    /// dictionary and were left out.
    Partial {
        /// Records left out.
        skipped: u16,
    },
    /// The last set that was saved; bits of the storage changed that are not part of it.
    Flawed,
    /// The last set is damaged: the values are those of the save before it.
    Older,
    /// A save was cut.
    Cut {
        /// The values keep their defaults, but for the operating records; else they are those that
        /// were saved before.
        factory: bool,
    },
    /// Another device, or another version of odkit, wrote what is there: the values keep their
    /// defaults.
    Foreign,
    /// The content cannot be read: the values keep their defaults.
    Damaged,
}
