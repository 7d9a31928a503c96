//! The lesson that watches a rig.

use crate::bench::Bench;
use crate::lesson::Progress;

/// A lesson in progress, and the names that its set-up gave the devices.
pub(super) struct Taken {
    pub(super) progress: Progress,
    /// Without its bus, which is the rig's.
    pub(super) names: Bench,
}
