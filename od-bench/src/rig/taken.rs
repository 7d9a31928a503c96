//! The lesson that watches a rig.

use crate::bench::Bench;
use crate::lesson::Progress;

/// A lesson that is taken, and the names that its set-up gave the devices.
pub(super) struct Taken {
    pub(super) progress: Progress,
    /// Without its bus, which is the rig's.
    pub(super) names: Bench,
}
