//! Frames on a line that takes time: one at a time, the lowest CAN-ID first. A station that is not connected has a
//! wire of its own, so its attempts take no time of the others.
//!
//! Times are in nanoseconds, because a bit at 800 kbit/s takes 1.25 µs.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::bits::{self, BEHIND_ACKNOWLEDGE, INTERMISSION, arbitration};

/// Reason why a frame failed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum FrameError {
    /// No station acknowledged it.
    NoAcknowledge,
    /// A station with another bit rate destroyed it.
    OtherBitRate,
    /// Reflections on a line without its terminators destroyed it.
    Reflections,
    /// Another station sent a different frame with the same CAN-ID at the same moment.
    SameId,
    /// A short circuit between CAN_H and CAN_L: the sender cannot make a bit dominant.
    ShortCircuit,
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
    pub error: FrameError,
    /// Number of failed attempts of this frame so far, this one included.
    pub attempts: u32,
    /// Transmit error counter of the sender after the attempt.
    pub transmit_errors: u16,
    /// Whether the sender went bus-off; the frame is lost then. Otherwise its controller sends it again.
    pub bus_off: bool,
}

/// Mailboxes of a CAN controller: it sends the frame with the lowest CAN-ID first.
pub(crate) const MAILBOXES: usize = 3;
/// Limit of waiting frames of the outside; a program has a queue before its controller.
const QUEUE: usize = 1000;
/// Time from a frame to the response of a device, in microseconds.
pub(crate) const PROCESSING: u64 = 200;
/// Error flag (ISO 11898-1).
const FLAG: u64 = 6;
/// Error flag and its delimiter.
const ERROR_FRAME: u64 = FLAG + 8;
/// Bits of a frame that another station destroys, with the flags of both: that station sees no valid
/// bit times within the CAN-ID.
const DESTROYED: u64 = 20 + FLAG + ERROR_FRAME;
/// Bits that an error passive controller waits after the intermission before it sends again (ISO 11898-1).
const SUSPENSION: u64 = 8;
const NANOS: u64 = 1000;

/// Bits of an attempt to send a frame, without the intermission.
pub(super) fn bits_of(frame: &Frame, error: Option<FrameError>) -> u64 {
    match error {
        None => bits::count(frame),
        Some(FrameError::NoAcknowledge) => bits::count(frame) - BEHIND_ACKNOWLEDGE + ERROR_FRAME,
        Some(FrameError::ShortCircuit) => 1 + ERROR_FRAME,
        Some(_) => DESTROYED,
    }
}

/// Bits of an attempt that ends with an error in the bit with this number, counted from 0: the error flags of the
/// stations that see it follow one another.
pub(super) fn bits_until(place: u64) -> u64 {
    place + 1 + FLAG + ERROR_FRAME
}

/// A frame that a station wants to send.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting {
    /// Station: 0 is the outside, then come the devices.
    pub(crate) station: usize,
    pub(crate) frame: Frame,
    /// Number of failed attempts.
    pub(crate) attempts: u32,
    /// Transmit error counter of its sender after the last attempt.
    pub(crate) transmit_errors: u16,
    /// Whether the last attempt failed as the one before it did, without a change.
    pub(crate) repeats: bool,
    /// Time of the last attempt that was reported.
    pub(crate) reported: Option<Instant>,
    /// Time from which it may start, in nanoseconds.
    ready: u64,
    order: u64,
}

impl Waiting {
    /// Notes a failed attempt, after which the sender has this transmit error counter. Without an acknowledgement it stops
    /// at 128: the next attempts change nothing.
    pub(crate) fn failed(&mut self, error: FrameError, transmit_errors: u16) {
        self.repeats =
            error == FrameError::NoAcknowledge && self.transmit_errors == transmit_errors;
        self.attempts = self.attempts.saturating_add(1);
        self.transmit_errors = transmit_errors;
    }
}

/// The frame on the wire.
#[derive(Clone, Debug)]
struct Flight {
    end: u64,
    ended: Ended,
}

/// A frame that ended.
#[derive(Clone, Debug)]
pub(crate) struct Ended {
    /// The senders: one, or several that sent frames with the same CAN-ID at the same moment.
    pub(crate) senders: Vec<Waiting>,
    /// Senders that failed while the others continued their frame.
    pub(crate) beaten: Vec<Waiting>,
    /// Reason of the failure; `None`: the frame came through.
    pub(crate) error: Option<FrameError>,
    /// Whether the receivers take the frame.
    pub(crate) received: bool,
}

impl Ended {
    /// Returns whether a station sent the frame, or tried to.
    pub(crate) fn is_of(&self, station: usize) -> bool {
        let mut all = self.senders.iter().chain(&self.beaten);
        all.any(|one| one.station == station)
    }
}

/// A wire with one frame at a time.
#[derive(Clone, Debug, Default)]
struct Wire {
    /// The only station on it, which is not connected to the line; `None`: the wire is the line.
    station: Option<usize>,
    flight: Option<Flight>,
    /// Time from which the next frame may start, in nanoseconds.
    free: u64,
    /// Duration of a bit of the last frame, in nanoseconds.
    bit: u64,
}

/// The line, the wires of stations that are not connected to it, and the frames that wait.
#[derive(Clone, Debug)]
pub(crate) struct Medium {
    /// In the order in which they were queued first.
    waiting: Vec<Waiting>,
    /// The first is the line.
    wires: Vec<Wire>,
    /// Time during which the line was not idle, in nanoseconds.
    busy: u64,
    order: u64,
}

/// An event on the line.
pub(crate) enum Due {
    /// These stations start their frames, which have the highest priority of all waiting frames.
    Start(Vec<Waiting>),
    /// A frame ended, with or without success.
    End(Ended),
}

impl Default for Medium {
    fn default() -> Self {
        Self {
            waiting: Vec::new(),
            wires: vec![Wire::default()],
            busy: 0,
            order: 0,
        }
    }
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
            transmit_errors: 0,
            repeats: false,
            reported: None,
            ready: ready.as_micros() * NANOS,
            order: self.order,
        });
        true
    }

    /// Takes a station off the line, or connects it again. A station that is connected while it sends a frame starts the
    /// frame again on the line. Neither wire has two frames at the same time.
    pub(crate) fn set_apart(&mut self, station: usize, is_apart: bool) {
        let place = self.place(station);
        let free = self.wires[0].free;
        if is_apart && place == 0 {
            self.wires.push(Wire {
                station: Some(station),
                free,
                ..Wire::default()
            });
        } else if !is_apart && place > 0 {
            let wire = self.wires.remove(place);
            self.wires[0].free = free.max(wire.free);
            let flight = wire.flight.into_iter();
            for one in flight.flat_map(|flight| flight.ended.senders) {
                self.queue(one);
            }
        }
    }

    /// The number of the wire of a station.
    fn place(&self, station: usize) -> usize {
        let mut wires = self.wires.iter();
        let own = wires.position(|wire| wire.station == Some(station));
        own.unwrap_or(0)
    }

    /// The frames on the wires.
    fn flights(&self) -> impl Iterator<Item = &Flight> {
        self.wires.iter().filter_map(|wire| wire.flight.as_ref())
    }

    /// Returns whether a device can queue another frame.
    pub(crate) fn has_room(&self, station: usize) -> bool {
        self.count(station) < MAILBOXES
    }

    fn count(&self, station: usize) -> usize {
        let flies = self.flights().flat_map(|flight| {
            let ended = &flight.ended;
            let all = ended.senders.iter().chain(&ended.beaten);
            all.map(|one| one.station)
        });
        let waits = self.waiting.iter().map(|waiting| waiting.station);
        flies.chain(waits).filter(|one| *one == station).count()
    }

    /// Returns whether a frame of this station waits or is being sent.
    pub(crate) fn holds(&self, station: usize) -> bool {
        self.count(station) > 0
    }

    /// Returns whether no station acknowledges a frame of this station, which it repeats without end.
    pub(crate) fn repeats(&self, station: usize) -> bool {
        let flying = self.flights().flat_map(|flight| &flight.ended.senders);
        let mut all = self.waiting.iter().chain(flying);
        all.any(|one| one.station == station && one.repeats)
    }

    /// Returns whether this frame of the outside waits.
    pub(crate) fn waits(&self, frame: &Frame) -> bool {
        let mut waiting = self.waiting.iter();
        waiting.any(|one| one.station == 0 && one.frame == *frame)
    }

    /// Returns whether this frame of the outside waits or is being sent.
    #[cfg(feature = "serve")]
    pub(crate) fn carries(&self, frame: &Frame) -> bool {
        let mut flying = self.flights().flat_map(|flight| &flight.ended.senders);
        self.waits(frame) || flying.any(|one| one.station == 0 && one.frame == *frame)
    }

    /// Time of the next event.
    pub(crate) fn due(&self) -> Option<Instant> {
        let (nanos, _) = self.next()?;
        Some(Instant::from_micros(nanos.div_ceil(NANOS)))
    }

    /// The time of the next event in nanoseconds, and the number of its wire.
    fn next(&self) -> Option<(u64, usize)> {
        let mut first: Option<(u64, usize)> = None;
        for (place, wire) in self.wires.iter().enumerate() {
            let event = match &wire.flight {
                Some(flight) => Some(flight.end),
                None => self.candidates(place).map(|one| self.start(one)).min(),
            };
            if let Some(at) = event
                && first.is_none_or(|(earliest, _)| at < earliest)
            {
                first = Some((at, place));
            }
        }
        first
    }

    /// The frames that can be the next one on a wire. A program sends its frames in order, so only the oldest of the outside
    /// can.
    fn candidates(&self, place: usize) -> impl Iterator<Item = &Waiting> {
        let mut waiting = self.waiting.iter();
        let oldest = waiting.find(|one| one.station == 0).map(|one| one.order);
        let can = move |one: &&Waiting| {
            self.place(one.station) == place && (one.station != 0 || Some(one.order) == oldest)
        };
        self.waiting.iter().filter(can)
    }

    /// Time at which a frame may start if no other frame does, in nanoseconds.
    fn start(&self, waiting: &Waiting) -> u64 {
        self.wires[self.place(waiting.station)]
            .free
            .max(waiting.ready)
    }

    /// Takes the event of a time. The caller returns a frame that starts to
    /// [`begin`](Self::begin).
    pub(crate) fn take(&mut self, now: Instant) -> Option<Due> {
        let (first, place) = self.next()?;
        if Instant::from_micros(first.div_ceil(NANOS)) > now {
            return None;
        }
        if let Some(flight) = self.wires[place].flight.take() {
            return Some(Due::End(flight.ended));
        }
        // All frames that are ready at the first possible start take part.
        let takes_part = |one: &Waiting| self.start(one) <= first;
        let mut parts: Vec<Waiting> = self.candidates(place).copied().filter(takes_part).collect();
        let lowest = parts.iter().map(|one| arbitration(&one.frame)).min()?;
        parts.retain(|one| arbitration(&one.frame) == lowest);
        // A station sends one frame at a time, its oldest.
        let mut starters: Vec<Waiting> = Vec::with_capacity(1);
        for one in parts {
            if starters.iter().all(|other| other.station != one.station) {
                starters.push(one);
            }
        }
        let starts = |order| starters.iter().any(|one| one.order == order);
        self.waiting.retain(|one| !starts(one.order));
        Some(Due::Start(starters))
    }

    /// Puts a frame on the wire of its senders for this number of bits at this bit rate in kbit/s; it will end with `ended`.
    pub(crate) fn begin(&mut self, ended: Ended, kbit: u16, bits: u64) {
        let nanos = |count: u64| count * 1_000_000 / u64::from(kbit.max(1));
        let all = || ended.senders.iter().chain(&ended.beaten);
        let start = all().map(|one| self.start(one)).max();
        let place = all().next().map_or(0, |one| self.place(one.station));
        let taken = nanos(bits + INTERMISSION);
        if place == 0 {
            self.busy += taken;
        }
        let wire = &mut self.wires[place];
        let start = start.unwrap_or(wire.free);
        wire.free = start + taken;
        wire.bit = nanos(1);
        wire.flight = Some(Flight {
            end: start + nanos(bits),
            ended,
        });
    }

    /// Queues a failed frame again: its controller repeats it. An error passive one lets others go first
    /// (ISO 11898-1, suspend transmission).
    pub(crate) fn again(&mut self, mut waiting: Waiting, is_passive: bool) {
        if is_passive {
            let Wire { free, bit, .. } = self.wires[self.place(waiting.station)];
            waiting.ready = free + SUSPENSION * bit;
        }
        self.queue(waiting);
    }

    /// Puts a frame back to its place among those that wait.
    fn queue(&mut self, waiting: Waiting) {
        let later = |one: &Waiting| one.order > waiting.order;
        let place = self.waiting.iter().position(later);
        let place = place.unwrap_or(self.waiting.len());
        self.waiting.insert(place, waiting);
    }

    /// Forgets all frames.
    pub(crate) fn clear(&mut self) {
        self.waiting.clear();
        self.wires.iter_mut().for_each(|wire| wire.flight = None);
    }

    /// Forgets the frames of a station that lost its power.
    pub(crate) fn forget(&mut self, station: usize) {
        self.waiting.retain(|one| one.station != station);
        for wire in &mut self.wires {
            if let Some(Flight { ended, .. }) = &mut wire.flight {
                ended.senders.retain(|one| one.station != station);
                ended.beaten.retain(|one| one.station != station);
            }
        }
    }

    /// Removes a station; later ones move up.
    pub(crate) fn remove(&mut self, station: usize) {
        self.forget(station);
        self.wires.retain(|wire| wire.station != Some(station));
        let move_up = |one: &mut usize| *one -= usize::from(*one > station);
        for wire in &mut self.wires {
            wire.station.iter_mut().for_each(move_up);
            if let Some(Flight { ended, .. }) = &mut wire.flight {
                let flying = ended.senders.iter_mut().chain(&mut ended.beaten);
                flying.for_each(|one| move_up(&mut one.station));
            }
        }
        let waiting = self.waiting.iter_mut();
        waiting.for_each(|one| move_up(&mut one.station));
    }

    /// Microseconds during which the line was not idle; a frame that is being sent counts completely.
    pub(crate) fn busy(&self) -> u64 {
        self.busy / NANOS
    }
}
