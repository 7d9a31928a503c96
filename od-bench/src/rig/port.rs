//! The link of a rig to a real bus.

use std::collections::VecDeque;
use std::prelude::v1::*;

use od_wire::Frame;

/// Frames that go out, and counts of those that did not.
#[derive(Default)]
pub(super) struct Port {
    pub(super) sends: bool,
    pub(super) out: VecDeque<Frame>,
    /// Frames that were held back.
    pub(super) held: u64,
    /// Number of items that were dropped before they were drained.
    pub(super) dropped: u64,
}
