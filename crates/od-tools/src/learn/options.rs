//! Options for a learned file.

/// Options of [`learn`](super::learn()).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// Probe limits by writing; the values are restored.
    pub writes: bool,
    /// Creation time in the file.
    pub today: Option<Today>,
}

/// A calendar date and time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Today {
    /// Year, as in 2026.
    pub year: u16,
    /// Month and day, from 1.
    pub month: u8,
    /// See `month`.
    pub day: u8,
    /// Hour and minute, from 0.
    pub hour: u8,
    /// See `hour`.
    pub minute: u8,
}
