//! Frames that a program sends cyclically.

use od_wire::{Frame, Instant};

/// Frames of one task, sent in turn, one per period.
#[derive(Clone, Debug)]
pub(crate) struct Cyclic {
    pub(crate) id: u32,
    /// The bus that sends.
    pub(crate) port: u32,
    pub(crate) frames: Vec<Frame>,
    /// Microseconds, at least 1.
    pub(crate) period: u64,
    /// Microseconds from the start to the end; `None`: without an end.
    pub(crate) duration: Option<u64>,
    /// Whether Python makes each frame.
    pub(crate) calls: bool,
    /// Index of the next frame.
    turn: usize,
    /// Time when the next frame is due; `None` while it is stopped.
    next: Option<Instant>,
    end: Option<Instant>,
}

impl Cyclic {
    /// A stopped task.
    pub(crate) fn new(
        id: u32,
        port: u32,
        frames: Vec<Frame>,
        (period, duration): (u64, Option<u64>),
        calls: bool,
    ) -> Self {
        Self {
            id,
            port,
            frames,
            period: period.max(1),
            duration,
            calls,
            turn: 0,
            next: None,
            end: None,
        }
    }

    /// Starts with its first frame, which is due at once.
    pub(crate) fn start(&mut self, now: Instant) {
        self.turn = 0;
        self.next = Some(now);
        self.end = self.duration.map(|micros| now.plus_micros(micros));
    }

    /// Stops; it sends nothing until it starts again.
    pub(crate) fn stop(&mut self) {
        self.next = None;
    }

    /// Time when the next frame is due.
    pub(crate) fn due(&self) -> Option<Instant> {
        self.next
    }

    /// Returns the frame that is due, and its index.
    pub(crate) fn take(&mut self, now: Instant) -> Option<(usize, Frame)> {
        let due = self.next.filter(|due| *due <= now)?;
        if self.end.is_some_and(|end| due >= end) {
            self.next = None;
            return None;
        }
        self.next = Some(due.plus_micros(self.period));
        let at = self.turn;
        self.turn = (at + 1) % self.frames.len().max(1);
        Some((at, *self.frames.get(at)?))
    }
}
