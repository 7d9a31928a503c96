//! A bus with what its user adds: a record of all frames, profiles for shafts, cyclic frames, an SDO client,
//! and a lesson.

mod client;
mod clockwork;
mod devices;
#[cfg(feature = "lessons")]
mod lesson;
#[cfg(feature = "real")]
mod real;

use std::collections::VecDeque;
use std::prelude::v1::*;

use od_model::Address;
use od_wire::{Frame, Instant, NodeId};

use self::client::SdoClient;
use self::clockwork::{Clockwork, Tick};
#[cfg(feature = "lessons")]
use crate::bench::Bench;
use crate::bus::{Bus, Sent};
use crate::device::VirtualDevice;
#[cfg(feature = "lessons")]
use crate::lesson::Progress;
use crate::line::Disturbance;

pub use self::client::Outcome;

/// Event on the bus line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LineEvent {
    /// A frame.
    Frame {
        /// Time of the frame.
        at: Instant,
        /// The device that sent it; `None` if it came from outside.
        device: Option<usize>,
        /// The frame.
        frame: Frame,
    },
    /// A frame from a link, with the device that describes its sender.
    Heard {
        /// Time of the event.
        at: Instant,
        /// The device that describes its sender.
        device: Option<usize>,
        /// The frame.
        frame: Frame,
    },
    /// A failed attempt to send a frame.
    Disturbed(Disturbance),
}

/// A bus with its profiles, cyclic frames, SDO client and lesson.
///
/// ```
/// use od_sim::rig::Rig;
/// use od_model::Address;
/// use od_wire::{Instant, NodeId};
///
/// let mut rig = Rig::default();
/// let encoder = od_devices::find("gxmm").expect("a built-in device");
/// rig.put_kind(encoder, NodeId::ONE, None);
/// rig.read(NodeId::ONE, Address::new(0x6001, 0));
/// while let Some(frame) = rig.request() {
///     rig.send(&frame);
///     rig.pass(Instant::from_micros(10_000), usize::MAX);
/// }
/// let outcome = rig.outcome().expect("a response");
/// assert_eq!(outcome.result, Ok(vec![0x00, 0x20, 0, 0]));
/// ```
#[derive(Default)]
pub struct Rig {
    /// The bus. [`collect_frames`](Self::collect_frames) records the frames that devices send because of a change.
    pub bus: Bus,
    clockwork: Clockwork,
    seen: Vec<LineEvent>,
    client: SdoClient,
    outcomes: VecDeque<Outcome>,
    /// Whether new devices describe nodes of a real bus.
    #[cfg(feature = "real")]
    pub(crate) describes: bool,
    /// The link to a real bus.
    #[cfg(feature = "real")]
    link: Option<Link>,
    /// The lesson in progress.
    #[cfg(feature = "lessons")]
    lesson: Option<LessonRun>,
}

/// The link to a real bus: frames for it, and counts of frames that were held back or dropped.
#[cfg(feature = "real")]
#[derive(Default)]
struct Link {
    sends: bool,
    out: VecDeque<Frame>,
    /// Number of frames that were held back because sending is off.
    held: u64,
    /// Number of items that were dropped before they were drained.
    dropped: u64,
}

/// A lesson in progress, and the names that its set-up gave the devices.
#[cfg(feature = "lessons")]
struct LessonRun {
    progress: Progress,
    /// The bench without its bus, which belongs to the rig.
    names: Bench,
}

impl Rig {
    /// A bus without devices at this time.
    pub fn at(now: Instant) -> Self {
        let mut rig = Self::default();
        rig.bus.advance(now);
        rig
    }

    /// Removes everything from the bus and starts at time 0 again. Open transfers end.
    pub fn clear(&mut self) {
        self.outcomes.extend(self.client.give_up());
        let Self {
            client, outcomes, ..
        } = std::mem::take(self);
        (self.client, self.outcomes) = (client, outcomes);
    }

    /// Takes the SDO client of a replaced bench, and ends its transfers.
    pub(crate) fn take_client(&mut self, before: &mut Self) {
        before.clear();
        std::mem::swap(&mut self.client, &mut before.client);
        std::mem::swap(&mut self.outcomes, &mut before.outcomes);
    }

    /// Sends a frame from outside.
    pub fn send(&mut self, frame: &Frame) {
        if !self.offer_to_link(frame) {
            return;
        }
        let now = self.bus.now();
        let came_through = self.bus.receive(frame);
        self.collect_disturbances();
        if came_through {
            self.record(LineEvent::Frame {
                at: now,
                device: None,
                frame: *frame,
            });
        }
        self.collect_frames();
    }

    /// Calls a function with a device, and collects its frames; `None` if the device does not exist.
    pub fn with<R>(
        &mut self,
        device: usize,
        act: impl FnOnce(&mut VirtualDevice, Instant) -> R,
    ) -> Option<R> {
        let result = self.bus.with(device, act);
        self.collect_frames();
        result
    }

    /// Lets a shaft follow `steps` from now on, pairs of rpm and milliseconds; without steps it keeps
    /// its speed.
    pub fn follow(&mut self, device: usize, steps: &[f64], repeats: bool) {
        let now = self.bus.now();
        self.clockwork.follow(device, steps, repeats, now);
    }

    /// Returns whether the shaft follows a profile.
    pub fn moves(&self, device: usize) -> bool {
        self.clockwork.moves(device)
    }

    /// Sends a frame at this interval in microseconds from now on; 0 ends it. `key` identifies the cyclic frame.
    pub fn repeat(&mut self, key: u32, frame: Frame, micros: u64) {
        let now = self.bus.now();
        self.clockwork.repeat(key, frame, micros, now);
    }

    /// Starts to read an object over the bus; the returned number is that of the [`Outcome`]. The
    /// client waits 500 ms for a response. [`request`](Self::request) returns its frames.
    pub fn read(&mut self, node: NodeId, address: Address) -> u32 {
        self.client.ask(self.bus.now(), node, address, None)
    }

    /// Starts to write an object, as [`read`](Self::read).
    pub fn write(&mut self, node: NodeId, address: Address, bytes: &[u8]) -> u32 {
        self.client.ask(self.bus.now(), node, address, Some(bytes))
    }

    /// Returns the next frame of the SDO client, for [`send`](Self::send).
    pub fn request(&mut self) -> Option<Frame> {
        self.client.request()
    }

    /// Returns the next finished transfer.
    pub fn outcome(&mut self) -> Option<Outcome> {
        self.outcomes.pop_front().or_else(|| self.client.poll())
    }

    /// Advances the time to `to`. Returns earlier if `full` items wait to be drained, a checkpoint of the lesson
    /// is reached, or the SDO client has a frame to send.
    pub fn pass(&mut self, to: Instant, full: usize) {
        let reached = self.reached();
        while self.seen.len() < full && self.reached() == reached {
            let now = self.bus.now();
            // A request comes after all other events of its moment, so that a repeated run
            // is the same.
            let overdue = self.client.poll_timeout().filter(|due| *due <= to);
            let to = if self.client.has_request() {
                now
            } else {
                overdue.unwrap_or(to)
            };
            let due = self.clockwork.due().filter(|due| *due <= to);
            // An observer acts after each frame; a real line may have events between two frames.
            let frames = if self.is_watched() || self.bus.line.is_real() {
                1
            } else {
                full - self.seen.len()
            };
            let until = due.unwrap_or(to).max(now);
            let sent = self.bus.advance_until_full(until, frames);
            self.collect_frames();
            if sent {
                continue;
            }
            match self.clockwork.take(self.bus.now()) {
                Some(tick) => self.happen(tick),
                None if due.is_some() => {}
                None if self.client.has_request() => return,
                None if overdue.is_some() => self.client.handle_timeout(self.bus.now()),
                None => return,
            }
        }
    }

    fn happen(&mut self, tick: Tick) {
        match tick {
            // A cyclic frame that still waits for the line is not sent twice: a busy line makes the cycle longer.
            Tick::Send(frame) if self.bus.is_waiting(&frame) => {}
            Tick::Send(frame) => self.send(&frame),
            Tick::Rpm(device, rpm) => {
                self.with(device, |device, now| device.set_rpm(rpm, now));
            }
        }
    }

    /// Number of items that wait to be drained.
    pub fn pending(&self) -> usize {
        self.seen.len()
    }

    /// Returns the items since the last call.
    pub fn drain(&mut self) -> Vec<LineEvent> {
        std::mem::take(&mut self.seen)
    }

    /// As [`drain`](Self::drain), without allocating a list: calls a function with each item.
    pub fn drain_to(&mut self, each: impl FnMut(&LineEvent)) {
        self.seen.iter().for_each(each);
        self.seen.clear();
    }

    /// Collects the frames of the devices, and passes them to record, SDO client, lesson and link.
    pub fn collect_frames(&mut self) {
        self.collect_disturbances();
        if !self.is_watched() {
            let sent = self.bus.poll_all();
            let seen = |Sent { at, device, frame }| LineEvent::Frame { at, device, frame };
            self.seen.extend(sent.map(seen));
            return;
        }
        while let Some(Sent { at, device, frame }) = self.bus.poll() {
            if !self.offer_to_link(&frame) {
                continue;
            }
            if device.is_some() {
                self.client.handle_frame(at, &frame);
            }
            self.record(LineEvent::Frame { at, device, frame });
        }
        self.check_lesson();
    }

    /// Returns whether SDO client, lesson or link react to frames.
    fn is_watched(&self) -> bool {
        self.client.is_busy() || self.has_lesson() || self.has_link()
    }

    fn collect_disturbances(&mut self) {
        while let Some(one) = self.bus.line.poll() {
            self.show_lesson_disturbance(one.at);
            self.seen.push(LineEvent::Disturbed(one));
        }
    }

    fn record(&mut self, seen: LineEvent) {
        self.drop_oldest();
        self.seen.push(seen);
        self.show_lesson(&seen);
    }
}

#[cfg(not(feature = "real"))]
impl Rig {
    fn offer_to_link(&mut self, _: &Frame) -> bool {
        true
    }

    fn drop_oldest(&mut self) {}

    fn has_link(&self) -> bool {
        false
    }
}

#[cfg(not(feature = "lessons"))]
impl Rig {
    fn show_lesson(&mut self, _: &LineEvent) {}

    fn show_lesson_disturbance(&mut self, _: Instant) {}

    /// A lesson would count this as an act of the learner; this bench has none.
    pub fn note_act(&mut self) {}

    fn check_lesson(&mut self) {}

    fn reached(&self) -> usize {
        0
    }

    fn has_lesson(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests;
