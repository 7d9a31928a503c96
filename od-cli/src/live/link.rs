//! Link of a client to a bus.

use std::time::Instant;

use od_wire::Frame;

use crate::failure::Failure;

/// Link that carries frames.
pub(crate) trait Link {
    /// Sends a frame.
    fn send(&mut self, frame: &Frame) -> Result<(), Failure>;
    /// The next frame, if one comes before `until`.
    fn receive(&mut self, until: Instant) -> Result<Option<Frame>, Failure>;
}
