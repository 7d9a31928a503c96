//! Commands of downloads to 1010h and 1011h, and the save in progress.

use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::storage::image::Banks;

/// Marks a restore in the place of a sub-index of 1010h.
pub(super) const RESTORE: u8 = u8::MAX;

/// Command of a download, with the sub-index of 1010h or 1011h. `None` is all zeros.
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

/// A save in progress, which can last longer than a call. A node without power has none, which is
/// all zeros.
#[derive(Clone, Debug)]
pub struct Saving {
    pub(super) command: Command,
    /// While a save is in progress: the set that waits for its commit word. If no set waits,
    /// everything is written, and the memory has not confirmed it yet.
    pub(super) banks: Banks,
    /// Sub-index of 1010h; [`RESTORE`]: a restore, whose event was sent already.
    pub(super) sub: u8,
    /// Time when the save is complete; never without a save.
    pub(super) due: Deadline,
}

impl Saving {
    /// Time when the save is complete; never without a save.
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
