//! The bus line: bit rates, terminators, and the error counters of the controllers.
//!
//! A [`Bus`](crate::bus::Bus) begins with an ideal line, on which every frame reaches all stations.
//! A real line treats a frame as CAN does. A station with another bit rate destroys
//! the frame while it is error active. A frame that no station acknowledges is
//! repeated. A controller with too many errors goes bus-off. Random events are
//! drawn from a seed, so the next run repeats them. A timed line also needs the time of each bit of
//! a frame at the bit rate: one frame at a time, the lowest identifier first.

pub mod bits;
mod controller;
mod medium;

use std::collections::VecDeque;
use std::prelude::v1::*;

use od_runtime::{BusEvent, Frame, Instant};

use self::controller::PASSIVE;
pub use self::controller::{Condition, Controller};
pub(crate) use self::medium::{Due, Medium, PROCESSING, Waiting};

/// Attempts after which a frame without an acknowledgement is given up: the transmit counter
/// is then at [`PASSIVE`] and would stay there for ever.
const ATTEMPTS: u16 = 16;
/// Limit of disturbances that are kept until they are read.
const KEPT: usize = 1000;

/// The state of a station at one time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Station {
    /// It has power and is connected.
    pub present: bool,
    /// Its bit rate in kbit/s; `None` adapts to any.
    pub rate: Option<u16>,
}

/// Reason why a frame failed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Trouble {
    /// Nobody acknowledged it.
    NoAcknowledge,
    /// A station with another bit rate destroyed it.
    OtherBitRate,
    /// Reflections on a line without its terminators destroyed it.
    Reflections,
}

/// A disturbed frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Disturbance {
    /// Time of the disturbance.
    pub at: Instant,
    /// Its sender; `None` for the outside.
    pub device: Option<usize>,
    /// The frame.
    pub frame: Frame,
    /// Reason of the last failed attempt.
    pub trouble: Trouble,
    /// Number of failed attempts.
    pub attempts: u16,
    /// Whether it was sent successfully in the end.
    pub delivered: bool,
    /// Whether its sender went bus-off.
    pub bus_off: bool,
}

/// The line between the stations. Station 0 is the outside, then come the devices.
#[derive(Clone, Debug)]
pub struct Line {
    /// Whether frames can fail.
    pub is_real: bool,
    /// Whether a frame takes time; only on a real line.
    is_timed: bool,
    pub(crate) medium: Medium,
    /// Terminating resistors of 120 Ω; there should be two.
    pub terminators: u8,
    /// The bit rate of the outside in kbit/s; `None`: that of the first device with power.
    pub bit_rate: Option<u16>,
    controllers: Vec<Controller>,
    unplugged: Vec<bool>,
    disturbed: VecDeque<Disturbance>,
    events: VecDeque<(usize, BusEvent)>,
    chance: u64,
}

impl Default for Line {
    fn default() -> Self {
        Self {
            is_real: false,
            is_timed: false,
            medium: Medium::default(),
            terminators: 2,
            bit_rate: None,
            controllers: Vec::new(),
            unplugged: Vec::new(),
            disturbed: VecDeque::new(),
            events: VecDeque::new(),
            chance: 0x9E37_79B9_7F4A_7C15,
        }
    }
}

impl Line {
    /// Makes the line real, with bit times, or ideal. Frames that wait for the line are lost.
    pub fn set_real(&mut self, real: bool) {
        if self.is_timed != real {
            self.medium.clear();
        }
        (self.is_real, self.is_timed) = (real, real);
    }

    /// Returns whether a frame takes time.
    pub fn is_timed(&self) -> bool {
        self.is_real && self.is_timed
    }

    /// Microseconds during which a timed line was not idle; a frame that is being sent counts completely.
    pub fn busy(&self) -> u64 {
        self.medium.busy()
    }

    /// Restarts the random numbers; the same seed gives the same sequence.
    pub fn set_seed(&mut self, seed: u64) {
        self.chance = seed ^ 0x9E37_79B9_7F4A_7C15;
    }

    /// The controller of a station: 0 is the outside, then come the devices.
    pub fn controller(&self, station: usize) -> Controller {
        self.controllers.get(station).copied().unwrap_or_default()
    }

    /// Returns the device, counted from 0, whose controller may be the next to restart after bus-off,
    /// and the time.
    pub(super) fn next_recovery(&self) -> Option<(Instant, usize)> {
        let devices = self.controllers.iter().skip(1).enumerate();
        devices
            .filter_map(|(device, controller)| Some((controller.recovers?, device)))
            .min()
    }

    /// Returns whether something will happen on the line without input.
    pub(super) fn has_plans(&self) -> bool {
        self.medium.due().is_some() || self.next_recovery().is_some()
    }

    /// Ends bus-off: the controller of the device restarts, or stays off until a power cycle.
    pub(super) fn recover(&mut self, device: usize, begins: bool) {
        if let Some(controller) = self.controllers.get_mut(device + 1) {
            controller.recovers = None;
            if begins {
                *controller = Controller::default();
            }
        }
    }

    /// Restarts a controller, as a power-on does.
    pub fn restart(&mut self, station: usize) {
        if let Some(controller) = self.controllers.get_mut(station) {
            *controller = Controller::default();
        }
    }

    /// Disconnects a station, or connects it again.
    pub fn set_plugged(&mut self, station: usize, plugged: bool) {
        if self.unplugged.len() <= station {
            self.unplugged.resize(station + 1, false);
        }
        self.unplugged[station] = !plugged;
    }

    /// Returns whether a station is connected.
    pub fn is_plugged(&self, station: usize) -> bool {
        !self.unplugged.get(station).copied().unwrap_or(false)
    }

    /// Removes a station; later ones move up.
    pub(super) fn remove(&mut self, station: usize) {
        self.medium.remove(station);
        if station < self.controllers.len() {
            self.controllers.remove(station);
        }
        if station < self.unplugged.len() {
            self.unplugged.remove(station);
        }
    }

    /// The next disturbed frame, oldest first.
    pub fn poll(&mut self) -> Option<Disturbance> {
        self.disturbed.pop_front()
    }

    /// The next controller whose state changed, and its new state.
    pub(super) fn poll_event(&mut self) -> Option<(usize, BusEvent)> {
        self.events.pop_front()
    }

    /// The bit rate of the outside.
    pub fn outside_rate(&self, stations: &[Station]) -> Option<u16> {
        let first = || {
            stations
                .iter()
                .skip(1)
                .find(|station| station.present && station.rate.is_some())
        };
        self.bit_rate
            .or_else(|| first().and_then(|station| station.rate))
    }

    /// Returns whether `to` understands frames of `from`.
    pub(super) fn hears(&self, stations: &[Station], from: usize, to: usize) -> bool {
        if !self.is_real {
            return self.is_plugged(to);
        }
        let (Some(sender), Some(listener)) = (stations.get(from), stations.get(to)) else {
            return false;
        };
        let listens = listener.present && self.is_plugged(to);
        listens
            && self.controller(to).condition() != Condition::BusOff
            && same_rate(sender.rate, listener.rate)
    }

    /// Sends a frame of a station. Returns whether it succeeded.
    pub(super) fn transmit(
        &mut self,
        at: Instant,
        stations: &[Station],
        from: usize,
        frame: &Frame,
    ) -> bool {
        if !self.is_real {
            return self.is_plugged(from);
        }
        let before = self.events_of(stations.len());
        let mut attempts = 0;
        let mut trouble = None;
        let delivered = loop {
            if self.controller(from).condition() == Condition::BusOff || attempts > 4 * ATTEMPTS {
                break false;
            }
            let Some(reason) = self.attempt(stations, from) else {
                break true;
            };
            attempts += 1;
            trouble = Some(reason);
            if reason == Trouble::NoAcknowledge && attempts >= ATTEMPTS {
                break false;
            }
        };
        if let Some(trouble) = trouble {
            self.keep(Disturbance {
                at,
                device: from.checked_sub(1),
                frame: *frame,
                trouble,
                attempts,
                delivered,
                bus_off: self.controller(from).condition() == Condition::BusOff,
            });
        }
        self.tell_changes(at, stations, before);
        delivered
    }

    /// Makes one attempt of a station on a timed line; `None` if it will succeed.
    pub(super) fn try_once(
        &mut self,
        at: Instant,
        stations: &[Station],
        from: usize,
    ) -> Option<Trouble> {
        let before = self.events_of(stations.len());
        let trouble = self.attempt(stations, from);
        self.tell_changes(at, stations, before);
        trouble
    }

    /// Returns whether a frame is given up after a failed attempt.
    pub(super) fn gives_up(&self, waiting: &Waiting) -> bool {
        let no_one = waiting.trouble == Some(Trouble::NoAcknowledge);
        self.controller(waiting.station).condition() == Condition::BusOff
            || waiting.attempts > 4 * ATTEMPTS
            || no_one && waiting.attempts >= ATTEMPTS
    }

    /// Keeps a disturbance until it is read.
    pub(super) fn keep(&mut self, disturbance: Disturbance) {
        if self.disturbed.len() == KEPT {
            self.disturbed.pop_front();
        }
        self.disturbed.push_back(disturbance);
    }

    /// The states of all controllers.
    fn events_of(&mut self, stations: usize) -> Vec<BusEvent> {
        self.controllers.resize(stations, Controller::default());
        self.controllers.iter().map(|one| one.event()).collect()
    }

    /// Notes the controllers whose state changed.
    fn tell_changes(&mut self, at: Instant, stations: &[Station], before: Vec<BusEvent>) {
        for (station, was) in before.into_iter().enumerate() {
            let is = self.controllers[station].event();
            if is != was {
                self.events.push_back((station, is));
                if is == BusEvent::Off {
                    self.controllers[station].waits(at, stations[station].rate);
                }
            }
        }
    }

    /// Makes one attempt; `None` if it succeeds.
    fn attempt(&mut self, stations: &[Station], from: usize) -> Option<Trouble> {
        let on_line = |line: &Self, station: usize| {
            line.is_plugged(station)
                && stations[station].present
                && line.controller(station).condition() != Condition::BusOff
        };
        let rate = stations[from].rate;
        let others: Vec<usize> = (0..stations.len())
            .filter(|station| *station != from && self.is_plugged(from) && on_line(self, *station))
            .collect();
        let same = |station: &usize| same_rate(rate, stations[*station].rate);
        let strangers: Vec<usize> = others
            .iter()
            .copied()
            .filter(|other| !same(other))
            .collect();
        let destroys = |line: &Self, station: &usize| {
            line.controller(*station).condition() == Condition::ErrorActive
        };
        let trouble = if strangers.iter().any(|other| destroys(self, other)) {
            Some(Trouble::OtherBitRate)
        } else if self.is_unlucky(rate) {
            Some(Trouble::Reflections)
        } else if !others.iter().any(same) {
            Some(Trouble::NoAcknowledge)
        } else {
            None
        };
        // A station that destroys a frame that all others accept was the first to see the error.
        let by = if others.iter().any(same) { 8 } else { 1 };
        for station in strangers {
            self.controllers[station].erred_receiving(by);
        }
        match trouble {
            None => {
                self.controllers[from].sent();
                for station in others.into_iter().filter(same) {
                    self.controllers[station].received();
                }
            }
            Some(Trouble::NoAcknowledge) => {
                // An error passive sender without an acknowledgement does not count further.
                if self.controllers[from].transmit < PASSIVE {
                    self.controllers[from].erred_sending();
                }
            }
            Some(_) => {
                self.controllers[from].erred_sending();
                for station in others.into_iter().filter(same) {
                    self.controllers[station].erred_receiving(1);
                }
            }
        }
        trouble
    }

    /// Returns whether reflections destroy this attempt. A faster line makes it more likely.
    fn is_unlucky(&mut self, rate: Option<u16>) -> bool {
        let rate = u64::from(rate.unwrap_or(500));
        let percent = match self.terminators {
            2 => return false,
            0 => (rate / 12 + 5).min(100),
            // One resistor is enough up to 125 kbit/s on the short line of a bench; a controller can compensate
            // for about 11 % of failures.
            1 => rate.saturating_sub(125) / 45,
            // Too many resistors take the signal level away from all stations.
            _ => rate / 20 + 5,
        };
        // xorshift64*: the same sequence of numbers on every computer.
        self.chance ^= self.chance >> 12;
        self.chance ^= self.chance << 25;
        self.chance ^= self.chance >> 27;
        (self.chance.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % 100 < percent
    }
}

/// A station that adapts has every bit rate.
fn same_rate(one: Option<u16>, other: Option<u16>) -> bool {
    one.is_none() || other.is_none() || one == other
}

#[cfg(test)]
mod tests;
