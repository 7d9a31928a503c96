//! Frames on a line that takes time: one at a time, the lowest identifier first.
//!
//! Times are in nanoseconds, because a bit at 800 kbit/s takes 1.25 µs.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::Trouble;
use super::bits::{self, BEHIND_ACKNOWLEDGE, INTERMISSION, arbitration};

/// Mailboxes of a CAN controller: it sends the frame with the lowest identifier first.
pub(crate) const MAILBOXES: usize = 3;
/// Limit of waiting frames of the outside; a program has a queue before its controller.
const QUEUE: usize = 1000;
/// Time from a frame to the response of a device, in microseconds.
pub(crate) const PROCESSING: u64 = 200;
/// Error flag and its delimiter (ISO 11898-1).
const ERROR_FRAME: u64 = 6 + 8;
/// Bits of a frame that another station destroys, with the flags of both: that station sees no valid
/// bit times within the identifier.
const DESTROYED: u64 = 20 + 6 + ERROR_FRAME;
const NANOS: u64 = 1000;

/// A frame that a station wants to send.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting {
    /// Station: 0 is the outside, then come the devices.
    pub(crate) station: usize,
    pub(crate) frame: Frame,
    /// Number of failed attempts, and the reason of the last one.
    pub(crate) attempts: u16,
    pub(crate) trouble: Option<Trouble>,
    ready: Instant,
    order: u64,
}

/// The frame on the wire.
#[derive(Clone, Copy, Debug)]
struct Flight {
    waiting: Waiting,
    end: u64,
    outcome: Option<Trouble>,
}

/// The line, and the frames that wait for it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Medium {
    waiting: Vec<Waiting>,
    flight: Option<Flight>,
    /// Time from which the next frame may start, in nanoseconds.
    free: u64,
    /// Time during which the line was not idle, in nanoseconds.
    busy: u64,
    order: u64,
}

/// An event on the line.
pub(crate) enum Due {
    /// This station starts its frame, which has the highest priority of all waiting frames.
    Start(Waiting),
    /// A frame ended, with or without success.
    End(Waiting, Option<Trouble>),
}

impl Medium {
    /// Queues a frame of a station, to be sent from `ready` on. Returns whether there is room for it.
    pub(crate) fn push(&mut self, station: usize, frame: Frame, ready: Instant) -> bool {
        let room = if station == 0 { QUEUE } else { MAILBOXES };
        if self.count(station) >= room {
            return false;
        }
        self.order += 1;
        self.waiting.push(Waiting {
            station,
            frame,
            attempts: 0,
            trouble: None,
            ready,
            order: self.order,
        });
        true
    }

    /// Returns whether a device can queue another frame.
    pub(crate) fn has_room(&self, station: usize) -> bool {
        self.count(station) < MAILBOXES
    }

    fn count(&self, station: usize) -> usize {
        let flies = self.flight.iter().map(|flight| flight.waiting.station);
        let waits = self.waiting.iter().map(|waiting| waiting.station);
        flies.chain(waits).filter(|one| *one == station).count()
    }

    /// Returns whether a frame of this station waits or is being sent.
    pub(crate) fn holds(&self, station: usize) -> bool {
        self.count(station) > 0
    }

    /// Returns whether this frame of the outside waits.
    pub(crate) fn waits(&self, frame: &Frame) -> bool {
        let mut waiting = self.waiting.iter();
        waiting.any(|one| one.station == 0 && one.frame == *frame)
    }

    /// Time of the next event.
    pub(crate) fn due(&self) -> Option<Instant> {
        let nanos = match self.flight {
            Some(flight) => flight.end,
            None => self.waiting.iter().map(|one| self.start(one)).min()?,
        };
        Some(Instant::from_micros(nanos.div_ceil(NANOS)))
    }

    /// Time at which a frame may start if no other frame does, in nanoseconds.
    fn start(&self, waiting: &Waiting) -> u64 {
        self.free.max(waiting.ready.as_micros() * NANOS)
    }

    /// Takes the event of a time. The caller returns a frame that starts to
    /// [`begin`](Self::begin).
    pub(crate) fn take(&mut self, now: Instant) -> Option<Due> {
        if self.due()? > now {
            return None;
        }
        if let Some(flight) = self.flight.take() {
            return Some(Due::End(flight.waiting, flight.outcome));
        }
        // All frames that are ready at the first possible start take part. A program sends its frames in
        // order, so only the oldest of the outside does.
        let first = self.waiting.iter().map(|one| self.start(one)).min()?;
        let outside = self.waiting.iter().filter(|one| one.station == 0);
        let oldest = outside.map(|one| one.order).min();
        let takes_part = |one: &Waiting| {
            self.start(one) <= first && (one.station != 0 || Some(one.order) == oldest)
        };
        let place = (0..self.waiting.len())
            .filter(|place| takes_part(&self.waiting[*place]))
            .min_by_key(|place| {
                let one = &self.waiting[*place];
                (arbitration(&one.frame), one.order)
            })?;
        Some(Due::Start(self.waiting.remove(place)))
    }

    /// Puts the frame on the line at this bit rate in kbit/s; it will end with `outcome`.
    pub(crate) fn begin(&mut self, waiting: Waiting, kbit: u16, outcome: Option<Trouble>) {
        let whole = bits::count(&waiting.frame);
        let count = match outcome {
            None => whole,
            Some(Trouble::NoAcknowledge) => whole - BEHIND_ACKNOWLEDGE + ERROR_FRAME,
            Some(_) => DESTROYED,
        };
        let nanos = |count: u64| count * 1_000_000 / u64::from(kbit.max(1));
        let start = self.start(&waiting);
        let end = start + nanos(count);
        self.free = start + nanos(count + INTERMISSION);
        self.busy += self.free - start;
        self.flight = Some(Flight {
            waiting,
            end,
            outcome,
        });
    }

    /// Queues a failed frame again: its controller repeats it.
    pub(crate) fn again(&mut self, waiting: Waiting) {
        self.waiting.push(waiting);
    }

    /// Forgets all frames.
    pub(crate) fn clear(&mut self) {
        self.waiting.clear();
        self.flight = None;
    }

    /// Forgets the frames of a station that lost its power.
    pub(crate) fn forget(&mut self, station: usize) {
        self.waiting.retain(|one| one.station != station);
        if self
            .flight
            .is_some_and(|flight| flight.waiting.station == station)
        {
            self.flight = None;
        }
    }

    /// Removes a station; later ones move up.
    pub(crate) fn remove(&mut self, station: usize) {
        self.forget(station);
        let flying = self.flight.iter_mut().map(|flight| &mut flight.waiting);
        for one in self.waiting.iter_mut().chain(flying) {
            one.station -= usize::from(one.station > station);
        }
    }

    /// Microseconds during which the line was not idle; a frame that is being sent counts completely.
    pub(crate) fn busy(&self) -> u64 {
        self.busy / NANOS
    }
}
