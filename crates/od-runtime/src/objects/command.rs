//! Commands of downloads to 1010h and 1011h, and the save in progress.

use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::storage::image::Banks;

/// No sub-index of 1010h that saves.
pub(super) const RESTORE: u8 = u8::MAX;

/// Command of a download, with the sub-index of 1010h or 1011h. `Nothing` is all zeros.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(u8)]
pub(super) enum Command {
    #[default]
    None,
    Save(u8),
    Restore(u8),
}

/// Command of the device itself: saves the operating records only.
pub(super) const KEEP: Command = Command::Save(0);

/// A save, which outlasts the call if it takes its time. A node without power has none, which is all zeros.
#[derive(Clone, Debug)]
pub struct Saving {
    pub(super) command: Command,
    /// While a save goes on, the set that waits for its commit word; without one all is written, and on its
    /// way to the memory that keeps it.
    pub(super) banks: Banks,
    /// Sub-index of 1010h; [`RESTORE`]: it is a restore, which was reported.
    pub(super) sub: u8,
    /// It is complete then; never without one.
    pub(super) due: Deadline,
}

impl Saving {
    /// Time when it is complete; never without one.
    pub(crate) const fn due(&self) -> Deadline {
        self.due
    }
}

impl Blank for Saving {
    const BLANK: Self = Self {
        command: Command::None,
        banks: Banks::NONE,
        sub: 0,
        due: Deadline::NEVER,
    };
}
