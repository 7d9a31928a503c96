//! Frames on a line that takes time: who sends next, who receives what was sent, and what is sent
//! again.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::{Bus, Sent};
use crate::wire::{Condition, Disturbance, Due, PROCESSING, Waiting};

/// Bits of an extended frame with eight bytes, all stuff bits that there can be, and the three
/// bits behind it.
const LONGEST_FRAME: u64 = 163;

impl Bus {
    /// Puts a frame of the outside in the queue for the wire. It is [polled](Bus::poll) when it
    /// came through.
    pub(super) fn queue(&mut self, frame: &Frame) {
        self.line.medium.push(0, *frame, self.now);
    }

    /// The next deadline of any device, of a controller that recovers from bus-off, or of a frame
    /// on a timed line.
    pub fn next_deadline(&self) -> Option<Instant> {
        let devices = (0..self.devices.len()).filter_map(|device| self.deadline(device));
        let controller = self.line.next_recovery().map(|(at, _)| at);
        devices
            .chain(controller)
            .chain(self.line.medium.due())
            .min()
    }

    /// The next frame that a device sent; those of the outside are dropped. For a host that passes
    /// frames of the outside on when they come.
    #[cfg(feature = "serve")]
    pub(crate) fn poll_device(&mut self) -> Option<Sent> {
        core::iter::from_fn(|| self.poll()).find(|sent| sent.device.is_some())
    }

    /// Does a frame of this station wait for a timed line, or is it on it? Station 0 is the outside.
    pub fn is_sending(&self, station: usize) -> bool {
        self.line.medium.holds(station)
    }

    /// Microseconds by which a frame can come later than it was due, because it takes its bits and
    /// waits for one before it; 0 on a line that takes no time.
    pub(crate) fn longest_wait(&self) -> u64 {
        if !self.line.is_timed() {
            return 0;
        }
        let rate = self.stations().first().and_then(|outside| outside.rate);
        2 * LONGEST_FRAME * 1000 / u64::from(rate.unwrap_or(500).max(1))
    }

    /// Does this frame of the outside wait for a timed line?
    pub(crate) fn is_waiting(&self, frame: &Frame) -> bool {
        self.line.medium.waits(frame)
    }

    /// Time passes until something happens on the line or in a device; `false` if nothing will.
    pub(crate) fn advance_until_event(&mut self) -> bool {
        let Some(at) = self.next_deadline() else {
            return false;
        };
        self.step(at.max(self.now));
        true
    }

    /// Time when a device is due. One that wants to send waits for room in its controller.
    pub(super) fn deadline(&self, device: usize) -> Option<Instant> {
        let at = self.devices[device].poll_timeout()?;
        let waits = at <= self.now && self.line.is_timed();
        (!waits || self.line.medium.has_room(device + 1)).then_some(at)
    }

    /// Takes what a device has to send, as far as its controller has room for it.
    pub(super) fn load(&mut self, device: usize, ready: Instant) {
        let station = device + 1;
        while self.line.medium.has_room(station)
            && let Some(frame) = self.devices[device].poll_transmit(self.now)
        {
            self.line.medium.push(station, frame, ready);
        }
    }

    /// Does what is due on the wire at this moment.
    pub(super) fn carry(&mut self) {
        while let Some(due) = self.line.medium.take(self.now) {
            match due {
                Due::Start(waiting) => self.start_frame(waiting),
                Due::End(waiting, None) => self.deliver(&waiting),
                Due::End(mut waiting, Some(trouble)) => {
                    waiting.attempts += 1;
                    waiting.trouble = Some(trouble);
                    if self.line.gives_up(&waiting) {
                        self.end(&waiting, false);
                    } else {
                        self.line.medium.again(waiting);
                    }
                }
            }
            self.tell_controllers();
        }
    }

    fn start_frame(&mut self, waiting: Waiting) {
        let stations = self.stations();
        let is_there = stations.get(waiting.station).is_some_and(|one| one.present);
        // A controller that is bus-off sends nothing, and its frames are lost.
        if !is_there || self.line.controller(waiting.station).condition() == Condition::BusOff {
            return;
        }
        let outcome = self.line.try_once(self.now, &stations, waiting.station);
        let rate = stations[waiting.station].rate.or(stations[0].rate);
        self.line
            .medium
            .begin(waiting, rate.unwrap_or(500), outcome);
    }

    /// Everybody who can hears a frame that came through, and its sender has room for the next.
    fn deliver(&mut self, waiting: &Waiting) {
        if waiting.attempts > 0 {
            self.report(waiting, true);
        }
        let (station, frame, now) = (waiting.station, waiting.frame, self.now);
        let stations = self.stations();
        let sender = station.checked_sub(1);
        if sender.is_none_or(|device| {
            self.hears_outside(device) && self.line.hears(&stations, station, 0)
        }) {
            self.sent.push_back(Sent {
                at: now,
                device: sender,
                frame,
            });
        }
        for other in (0..self.devices.len()).filter(|other| Some(*other) != sender) {
            let hears = match sender {
                None => self.hears_outside(other),
                Some(device) => {
                    let (one, its) = (
                        self.devices[device].bit_rate(),
                        self.devices[other].bit_rate(),
                    );
                    self.wiring.hears(one, its)
                }
            };
            if hears && self.line.hears(&stations, station, other + 1) {
                self.devices[other].handle_frame(now, &frame);
                self.load(other, now.plus_micros(PROCESSING));
            }
        }
        if let Some(device) = sender {
            self.load(device, now);
        }
    }

    /// A frame is given up.
    fn end(&mut self, waiting: &Waiting, delivered: bool) {
        self.report(waiting, delivered);
        if let Some(device) = waiting.station.checked_sub(1) {
            self.load(device, self.now);
        }
    }

    fn report(&mut self, waiting: &Waiting, delivered: bool) {
        let Some(trouble) = waiting.trouble else {
            return;
        };
        self.line.keep(Disturbance {
            at: self.now,
            device: waiting.station.checked_sub(1),
            frame: waiting.frame,
            trouble,
            attempts: waiting.attempts,
            delivered,
            bus_off: self.line.controller(waiting.station).condition() == Condition::BusOff,
        });
    }
}

#[cfg(test)]
mod tests;
