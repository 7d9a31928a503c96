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
    /// Things that were dropped before anybody drained them.
    pub(super) dropped: u64,
}
