//! Frames on their way over a line that takes time: one at a time, the lowest identifier first.
//!
//! Moments are kept in nanoseconds, since a bit at 800 kbit/s takes 1.25 µs.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::Trouble;
use super::bits::{self, BEHIND_ACKNOWLEDGE, INTERMISSION, arbitration};

/// Mailboxes of a CAN controller: the frame with the lowest identifier in them goes first.
pub(crate) const MAILBOXES: usize = 3;
/// Frames of the outside that wait; a program has a queue before its controller.
const QUEUE: usize = 1000;
/// Time from a frame to the answer of a device, in microseconds.
pub(crate) const PROCESSING: u64 = 200;
/// Error flag and its delimiter (ISO 11898-1).
const ERROR_FRAME: u64 = 6 + 8;
/// Bits of a frame that another station destroys, with the flags of both: it sees no valid
/// bit times within the identifier.
const DESTROYED: u64 = 20 + 6 + ERROR_FRAME;
const NANOS: u64 = 1000;

/// A frame that a station wants to send.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting {
    /// Station: 0 is the outside, then come the devices.
    pub(crate) station: usize,
    pub(crate) frame: Frame,
    /// Attempts that failed, and why the last one did.
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

/// The wire, and who waits for it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Medium {
    waiting: Vec<Waiting>,
    flight: Option<Flight>,
    /// Nanosecond from which the next frame may start.
    free: u64,
    /// Nanoseconds that the wire was not idle.
    busy: u64,
    order: u64,
}

/// Something that is due on the wire.
pub(crate) enum Due {
    /// This station starts its frame, with the highest priority of all that wait.
    Start(Waiting),
    /// A frame ended; it came through, or did not.
    End(Waiting, Option<Trouble>),
}

impl Medium {
    /// A station wants to send a frame from `ready` on. Answers whether it has room for it.
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

    /// Can a device hand over another frame?
    pub(crate) fn has_room(&self, station: usize) -> bool {
        self.count(station) < MAILBOXES
    }

    fn count(&self, station: usize) -> usize {
        let flies = self.flight.iter().map(|flight| flight.waiting.station);
        let waits = self.waiting.iter().map(|waiting| waiting.station);
        flies.chain(waits).filter(|one| *one == station).count()
    }

    /// Does a frame of this station wait, or is it on the wire?
    pub(crate) fn holds(&self, station: usize) -> bool {
        self.count(station) > 0
    }

    /// Does this frame of the outside wait?
    pub(crate) fn waits(&self, frame: &Frame) -> bool {
        let mut waiting = self.waiting.iter();
        waiting.any(|one| one.station == 0 && one.frame == *frame)
    }

    /// Time when something is due next.
    pub(crate) fn due(&self) -> Option<Instant> {
        let nanos = match self.flight {
            Some(flight) => flight.end,
            None => self.waiting.iter().map(|one| self.start(one)).min()?,
        };
        Some(Instant::from_micros(nanos.div_ceil(NANOS)))
    }

    /// Nanosecond at which a frame may start if nothing else does.
    fn start(&self, waiting: &Waiting) -> u64 {
        self.free.max(waiting.ready.as_micros() * NANOS)
    }

    /// Takes what is due at a moment. A frame that starts is handed back to
    /// [`begin`](Self::begin).
    pub(crate) fn take(&mut self, now: Instant) -> Option<Due> {
        if self.due()? > now {
            return None;
        }
        if let Some(flight) = self.flight.take() {
            return Some(Due::End(flight.waiting, flight.outcome));
        }
        // All that are ready at the first possible start take part; a program sends its frames in
        // their order, so of the outside only the oldest does.
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

    /// The frame is on the wire at this bit rate in kbit/s, and will end as `outcome` says.
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

    /// The frame goes back to those that wait: its controller sends it again.
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

    /// Removes a station; those behind it move up.
    pub(crate) fn remove(&mut self, station: usize) {
        self.forget(station);
        let flying = self.flight.iter_mut().map(|flight| &mut flight.waiting);
        for one in self.waiting.iter_mut().chain(flying) {
            one.station -= usize::from(one.station > station);
        }
    }

    /// Microseconds that the wire was not idle so far; a frame on the wire counts whole.
    pub(crate) fn busy(&self) -> u64 {
        self.busy / NANOS
    }
}
