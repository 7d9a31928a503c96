//! Result of a load.

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
