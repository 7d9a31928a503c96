//! Frames at the period that was measured, not at the configured one.

use od_runtime::{Frame, Instant};

/// A cyclic frame of a node, sent at another period.
#[derive(Clone, Debug)]
pub(super) struct Pace {
    /// Measured period, in microseconds.
    period: u64,
    /// The configured period with which it was measured.
    pub(super) configured: u64,
    /// The frame as the node last had it, and when it is sent next.
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

    /// The node has this frame now. Only the first one goes out at once.
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

    /// Time when the next frame goes out.
    pub(super) fn due(&self) -> Option<Instant> {
        self.next.map(|(at, _)| at)
    }

    /// The frame that is due now.
    pub(super) fn take(&mut self, now: Instant) -> Option<Frame> {
        let (at, frame) = self.next.filter(|(at, _)| *at <= now)?;
        self.next = Some((at.plus_micros(self.period), frame));
        Some(frame)
    }

    /// The node does not send it, or is configured to another period.
    pub(super) fn forget(&mut self) {
        self.next = None;
    }
}
