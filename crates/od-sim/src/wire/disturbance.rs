//! Failed attempts to send a frame.

use od_runtime::{Frame, Instant};

/// Reason why a frame failed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Trouble {
    /// Nobody acknowledged it.
    NoAcknowledge,
    /// A station with another bit rate destroyed it.
    OtherBitRate,
    /// Reflections on a line without its terminators destroyed it.
    Reflections,
    /// Another station sent a different frame with the same identifier at the same moment.
    SameId,
}

/// A failed attempt to send a frame, at the end of its error frame. While a frame without an acknowledgement
/// repeats without end, one attempt per second is reported.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Disturbance {
    /// Time of the end of the error frame.
    pub at: Instant,
    /// Its sender; `None` for the outside.
    pub device: Option<usize>,
    /// The frame.
    pub frame: Frame,
    /// Reason.
    pub trouble: Trouble,
    /// Number of failed attempts of this frame so far, this one included.
    pub attempts: u32,
    /// Transmit error counter of the sender after the attempt.
    pub transmit_errors: u16,
    /// Whether the sender went bus-off; the frame is lost then. Otherwise its controller sends it again.
    pub bus_off: bool,
}
