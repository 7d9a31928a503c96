//! Sends frames at the measured instead of the configured period.

use od_runtime::{Frame, Instant};

/// A cyclic frame of a node, sent at another period.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    /// Measured period, in microseconds.
    period: u64,
    /// The configured period with which it was measured.
    pub(super) configured: u64,
    /// The last frame of the node, and the time when it is sent next.
    next: Option<(Instant, Frame)>,
}

impl Pace {
    pub(super) const fn new(period: u64, configured: u64) -> Self {
        Self {
            period,
            configured,
            next: None,
        }
    }

    /// Accepts a frame of the node. Only the first one is sent at once.
    pub(super) fn passes(&mut self, now: Instant, frame: &Frame) -> bool {
        match &mut self.next {
            Some((_, held)) => {
                *held = *frame;
                false
            }
            next @ None => {
                *next = Some((now.plus_micros(self.period), *frame));
                true
            }
        }
    }

    /// Time of the next frame.
    pub(super) fn due(&self) -> Option<Instant> {
        self.next.map(|(at, _)| at)
    }

    /// The frame that is due now.
    pub(super) fn take(&mut self, now: Instant) -> Option<Frame> {
        let (at, frame) = self.next.filter(|(at, _)| *at <= now)?;
        self.next = Some((at.plus_micros(self.period), frame));
        Some(frame)
    }

    /// Stops: the node does not send the frame, or with another configured period.
    pub(super) fn forget(&mut self) {
        self.next = None;
    }
}
