//! Frames on a line that takes time: which is sent next, who receives it, and which are sent again.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::{Bus, Sent};
use crate::line::{Disturbance, Due, Ended, ErrorState, FrameError, PROCESSING, Waiting};

/// Bits of an extended frame with eight bytes, with the greatest number of stuff bits and the three
/// bits after it.
const LONGEST_FRAME: u64 = 163;
/// Microseconds between two reports of a frame that is repeated without a change.
const BETWEEN_REPORTS: u64 = 1_000_000;

impl Bus {
    /// Queues a frame of the outside for a real line. It is [polled](Bus::poll) after its
    /// transmission. Returns `false` if the queue is full, and the frame is lost.
    pub(crate) fn queue(&mut self, frame: &Frame) -> bool {
        self.line.medium.push(0, *frame, self.now)
    }

    /// Returns whether a frame of this station waits for a real line or is being sent. Station 0 is
    /// the outside.
    pub fn is_sending(&self, station: usize) -> bool {
        self.line.medium.holds(station)
    }

    /// Microseconds by which a frame can be late, because of its bits and of a frame before it; 0
    /// on a line that takes no time.
    pub(crate) fn longest_wait(&self) -> u64 {
        if !self.line.is_real() {
            return 0;
        }
        let rate = self.stations().first().and_then(|outside| outside.rate);
        2 * LONGEST_FRAME * 1000 / u64::from(rate.unwrap_or(500).max(1))
    }

    /// Returns whether a frame is being sent on a real line or waits for it, except one that is
    /// repeated without end.
    pub fn is_busy(&self) -> bool {
        (0..=self.devices.len()).any(|station| self.is_sending(station) && !self.is_stuck(station))
    }

    /// Returns whether a frame of this station is repeated without end, because no station
    /// acknowledges it.
    pub(crate) fn is_stuck(&self, station: usize) -> bool {
        self.line.medium.repeats(station)
    }

    /// Returns whether this frame of the outside waits for a real line.
    pub(crate) fn is_waiting(&self, frame: &Frame) -> bool {
        self.line.medium.waits(frame)
    }

    /// Returns whether a frame that the outside gave to a real line was sent; `false`: it waits its turn.
    ///
    /// # Errors
    /// Reason why it is not on the line, and what to do.
    #[cfg(feature = "serve")]
    pub(crate) fn is_sent(&self, frame: &Frame) -> Result<bool, String> {
        if self.line.medium.carries(frame) {
            if self.is_stuck(0) {
                return Err(format!(
                    "no node acknowledges {frame}; its CAN controller repeats it until a node does"
                ));
            }
            return Ok(false);
        }
        match self.line.controller(0).error_state() {
            ErrorState::BusOff => Err(format!(
                "{frame} is lost: the CAN controller of the clients is bus-off after too many errors; remove their \
                 cause, then write `line restart`"
            )),
            _ => Ok(true),
        }
    }

    /// Collects the frames of a device, as far as its controller has room.
    pub(super) fn load(&mut self, device: usize, ready: Instant) {
        let station = device + 1;
        while self.line.medium.has_room(station)
            && let Some(frame) = self.devices[device].poll_transmit(self.now)
        {
            self.line.medium.push(station, frame, ready);
        }
    }

    /// Handles the events of the line at this time.
    pub(super) fn run_line(&mut self) {
        while let Some(due) = self.line.medium.take(self.now) {
            match due {
                Due::Start(starters) => self.start_frames(starters),
                Due::End(ended) => self.end(ended),
            }
            self.report_controllers();
        }
    }

    fn start_frames(&mut self, mut starters: Vec<Waiting>) {
        let stations = self.stations();
        // A controller that is bus-off sends nothing, and its frames are lost.
        starters.retain(|one| {
            stations.get(one.station).is_some_and(|it| it.present)
                && self.line.controller(one.station).error_state() != ErrorState::BusOff
        });
        // A station with another bit rate does not compare its bits with those of the others.
        let rate = |one: &Waiting| stations[one.station].rate;
        if let Some(first) = starters.first().copied() {
            let (together, later): (Vec<Waiting>, Vec<Waiting>) = starters
                .into_iter()
                .partition(|one| one.station == first.station || rate(one) == rate(&first));
            starters = together;
            for one in later {
                self.line.medium.again(one, false);
            }
        }
        let frames: Vec<_> = starters
            .iter()
            .map(|one| (one.station, one.frame))
            .collect();
        let Some((station, _)) = frames.first() else {
            return;
        };
        let attempt = self.line.try_once(self.now, &stations, &frames);
        let rate = stations[*station].rate.or(stations[0].rate);
        let (beaten, senders) = starters
            .into_iter()
            .partition(|one| attempt.beaten.contains(&one.station));
        let ended = Ended {
            senders,
            beaten,
            error: attempt.error,
            received: attempt.received,
        };
        let medium = &mut self.line.medium;
        medium.begin(ended, rate.unwrap_or(500), attempt.bits);
    }

    /// Ends a frame: delivers it, or lets its controllers repeat it.
    fn end(&mut self, ended: Ended) {
        if ended.received {
            self.deliver(&ended);
        }
        if ended.error.is_none() {
            // Its senders have room for the next frame.
            let senders = ended.senders.iter();
            for device in senders.filter_map(|one| one.station.checked_sub(1)) {
                self.load(device, self.now);
            }
        }
        let failed = ended
            .senders
            .iter()
            .copied()
            .filter_map(|one| Some((one, ended.error?)));
        let beaten = ended.beaten.iter().map(|one| (*one, FrameError::SameId));
        for (mut waiting, error) in failed.chain(beaten) {
            let controller = self.line.controller(waiting.station);
            waiting.failed(error, controller.transmit);
            let state = controller.error_state();
            self.report(&mut waiting, error);
            if state != ErrorState::BusOff {
                let is_passive = state == ErrorState::ErrorPassive;
                self.line.medium.again(waiting, is_passive);
            } else if let Some(device) = waiting.station.checked_sub(1) {
                self.load(device, self.now);
            }
        }
    }

    /// Delivers a frame to all stations that can receive it.
    fn deliver(&mut self, ended: &Ended) {
        let Some(Waiting { station, frame, .. }) = ended.senders.first().copied() else {
            return;
        };
        let now = self.now;
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
            if sender.is_some() {
                self.tell_master(&frame);
            }
        }
        for other in (0..self.devices.len()).filter(|other| !ended.is_of(other + 1)) {
            let hears = match sender {
                None => self.hears_outside(other),
                Some(device) => {
                    let (one, its) = (
                        self.devices[device].bit_rate(),
                        self.devices[other].bit_rate(),
                    );
                    self.hears(one, its)
                }
            };
            let hears = hears && !self.line.misreads(&frame, station, other + 1);
            if hears && self.line.hears(&stations, station, other + 1) {
                self.devices[other].handle_frame(now, &frame);
                self.load(other, now.plus_micros(PROCESSING));
            }
        }
    }

    /// Reports a failed attempt. While nothing changes between attempts, one report per second is
    /// enough.
    fn report(&mut self, waiting: &mut Waiting, error: FrameError) {
        let controller = self.line.controller(waiting.station);
        let is_soon = |before: Instant| self.now.micros_since(before) < BETWEEN_REPORTS;
        if waiting.repeats && waiting.reported.is_some_and(is_soon) {
            return;
        }
        waiting.reported = Some(self.now);
        self.line.keep(Disturbance {
            at: self.now,
            device: waiting.station.checked_sub(1),
            frame: waiting.frame,
            error,
            attempts: waiting.attempts,
            transmit_errors: controller.transmit,
            bus_off: controller.error_state() == ErrorState::BusOff,
        });
    }
}

#[cfg(test)]
mod tests;
