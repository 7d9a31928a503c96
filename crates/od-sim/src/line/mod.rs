//! The bus line: bit rates, terminators, and the error counters of the controllers.
//!
//! A [`Bus`](crate::bus::Bus) begins with an ideal line, on which every frame reaches all stations
//! at once. A real line treats a frame as CAN does: it takes the time of its bits, one frame at a time,
//! the lowest CAN-ID first. A station with another bit rate destroys the frame while it is error active.
//! Two stations that send different frames with one CAN-ID at the same moment destroy both. A frame that
//! no station acknowledges is repeated. A controller with too many errors goes bus-off. Random events are
//! drawn from a seed, so the next run repeats them. With a [`cable`] the line has a length, a sample point and clocks
//! that deviate.

pub mod bits;
#[cfg_attr(not(feature = "training"), allow(dead_code))]
pub mod cable;
mod controller;
mod medium;

use std::collections::VecDeque;
use std::prelude::v1::*;

use od_runtime::{BusEvent, Frame, Instant};

use self::cable::{Measure, Property};
use self::controller::PASSIVE;
pub use self::controller::{Controller, ErrorState};
pub use self::medium::{Disturbance, FrameError};
pub(crate) use self::medium::{Due, Ended, Medium, PROCESSING, Waiting};
use crate::chance::Chance;

/// Limit of disturbances that are kept until they are read.
const KEPT: usize = 1000;
/// State of the random numbers for seed 0.
const CHANCE: u64 = 0x9E37_79B9_7F4A_7C15;

/// The state of a station at one time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Station {
    /// It has power and is connected.
    pub present: bool,
    /// Its bit rate in kbit/s; `None` adapts to any.
    pub rate: Option<u16>,
}

/// The result of an attempt of one or more stations with the same CAN-ID.
pub(super) struct Attempt {
    /// Reason of the failure; `None` if the frame will get through.
    pub(super) error: Option<FrameError>,
    /// Whether the receivers take the frame. On a line that is too long they do, although the sender repeats it.
    pub(super) received: bool,
    /// Bits until the line is free for the intermission.
    pub(super) bits: u64,
    /// Error passive stations that sent another frame and could not stop this one.
    pub(super) beaten: Vec<usize>,
}

/// The line between the stations. Station 0 is the outside, then come the devices.
#[derive(Clone, Debug)]
pub struct Line {
    is_real: bool,
    pub(crate) medium: Medium,
    /// Terminating resistors of 120 Ω; there should be two.
    pub terminators: u8,
    /// The bit rate of the outside in kbit/s; `None`: that of the first device with power.
    pub bit_rate: Option<u16>,
    controllers: Vec<Controller>,
    unplugged: Vec<bool>,
    disturbed: VecDeque<Disturbance>,
    events: VecDeque<(usize, BusEvent)>,
    chance: Chance,
    /// The physics of a real line.
    #[cfg(feature = "training")]
    pub cable: cable::Cable,
}

impl Default for Line {
    fn default() -> Self {
        Self {
            is_real: false,
            medium: Medium::default(),
            terminators: 2,
            bit_rate: None,
            controllers: Vec::new(),
            unplugged: Vec::new(),
            disturbed: VecDeque::new(),
            events: VecDeque::new(),
            chance: Chance::new(CHANCE),
            #[cfg(feature = "training")]
            cable: cable::Cable::default(),
        }
    }
}

impl Line {
    /// Makes the line real or ideal. Frames that wait for the line are lost.
    pub fn set_real(&mut self, real: bool) {
        if self.is_real != real {
            self.medium.clear();
        }
        self.is_real = real;
    }

    /// Returns whether frames take time and can fail.
    pub fn is_real(&self) -> bool {
        self.is_real
    }

    /// Microseconds during which a real line was not idle; a frame that is being sent counts completely.
    pub fn busy(&self) -> u64 {
        self.medium.busy()
    }

    /// Restarts the random numbers; the same seed gives the same sequence.
    pub fn set_seed(&mut self, seed: u64) {
        self.chance = Chance::new(seed ^ CHANCE);
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
        self.medium.set_apart(station, !plugged);
    }

    /// Returns whether a station is connected.
    pub fn is_plugged(&self, station: usize) -> bool {
        !self.unplugged.get(station).copied().unwrap_or(false)
    }

    /// Removes a station; later ones move up.
    pub(super) fn remove(&mut self, station: usize) {
        self.medium.remove(station);
        #[cfg(feature = "training")]
        self.cable.remove(station);
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
    pub(crate) fn outside_rate(&self, stations: &[Station]) -> Option<u16> {
        let first = || {
            stations
                .iter()
                .skip(1)
                .find(|station| station.present && station.rate.is_some())
        };
        self.bit_rate
            .or_else(|| first().and_then(|station| station.rate))
    }

    /// Returns whether `to` understands frames of `from` on a real line.
    pub(super) fn hears(&self, stations: &[Station], from: usize, to: usize) -> bool {
        let (Some(sender), Some(listener)) = (stations.get(from), stations.get(to)) else {
            return false;
        };
        let listens = listener.present && self.is_plugged(to);
        listens
            && self.controller(to).error_state() != ErrorState::BusOff
            && same_rate(sender.rate, listener.rate)
    }

    /// Makes one attempt on a real line: the stations that start a frame with the same CAN-ID at this moment,
    /// at least one.
    pub(super) fn try_once(
        &mut self,
        at: Instant,
        stations: &[Station],
        starters: &[(usize, Frame)],
    ) -> Attempt {
        let before = self.events_of(stations.len());
        let attempt = self.attempt_of(stations, starters);
        self.tell_changes(at, stations, before);
        attempt
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

    /// All starters have won the arbitration. The first bit in which their frames differ decides (ISO 11898-1, bit
    /// monitoring): a station that sends it recessive sees a bit error. Error active, it destroys the frame of
    /// all; error passive, it cannot, and the others continue.
    fn attempt_of(&mut self, stations: &[Station], starters: &[(usize, Frame)]) -> Attempt {
        let (mut left, mut beaten) = (starters.to_vec(), Vec::new());
        if self.is_shorted()
            && starters
                .iter()
                .any(|(station, _)| self.is_plugged(*station))
        {
            // Not even the start of frame is on the line, so no other station sees anything.
            for (station, _) in starters {
                self.controllers[*station].erred_sending();
            }
            let error = Some(FrameError::ShortCircuit);
            return Attempt {
                error,
                received: false,
                bits: medium::bits_of(&left[0].1, error),
                beaten,
            };
        }
        while let Some((place, recessive)) = first_difference(&left) {
            let active = |(station, _): &(usize, Frame)| {
                self.controller(*station).error_state() == ErrorState::ErrorActive
            };
            if recessive.iter().any(active) {
                let senders: Vec<usize> = starters.iter().map(|(station, _)| *station).collect();
                for (station, _) in &left {
                    self.controllers[*station].erred_sending();
                }
                for station in self.listeners(stations, &senders) {
                    if same_rate(stations[senders[0]].rate, stations[station].rate) {
                        self.controllers[station].erred_receiving(1);
                    }
                }
                return Attempt {
                    error: Some(FrameError::SameId),
                    received: false,
                    bits: medium::bits_until(place),
                    beaten,
                };
            }
            for (station, _) in recessive {
                self.controllers[station].erred_sending();
                left.retain(|(one, _)| *one != station);
                beaten.push(station);
            }
        }
        let senders: Vec<usize> = left.iter().map(|(station, _)| *station).collect();
        let (error, received) = self.attempt(stations, &senders, &beaten, &left[0].1);
        Attempt {
            error,
            received,
            bits: medium::bits_of(&left[0].1, error),
            beaten,
        }
    }

    /// The stations on the line that do not send.
    fn listeners(&self, stations: &[Station], senders: &[usize]) -> Vec<usize> {
        let on_line = |station: &usize| {
            self.is_plugged(*station)
                && stations[*station].present
                && self.controller(*station).error_state() != ErrorState::BusOff
        };
        (0..stations.len())
            .filter(|station| !senders.contains(station))
            .filter(|station| on_line(station) && senders.iter().any(|one| self.is_plugged(*one)))
            .collect()
    }

    /// Makes one attempt of stations that send the same frame. Returns the reason if it fails, and whether the receivers take the
    /// frame.
    ///
    /// An error passive sender without an acknowledgement counts only if it sees a dominant bit while it sends its error
    /// flag (ISO 11898-1, fault confinement, rule c, exception 1): the acknowledgement of a station far away, or the
    /// flag of another sender. The only sender sees none, so it never goes bus-off.
    fn attempt(
        &mut self,
        stations: &[Station],
        senders: &[usize],
        beaten: &[usize],
        frame: &Frame,
    ) -> (Option<FrameError>, bool) {
        let rate = stations[senders[0]].rate;
        let mut others = self.listeners(stations, senders);
        others.retain(|station| !beaten.contains(station));
        // A clock that deviates too far is another bit rate for the frames that it cannot follow.
        let follows: Vec<usize> = (others.iter().copied())
            .filter(|station| same_rate(rate, stations[*station].rate))
            .filter(|station| !self.misreads(frame, senders[0], *station))
            .collect();
        let same = |station: &usize| follows.contains(station);
        let strangers: Vec<usize> = others
            .iter()
            .copied()
            .filter(|other| !same(other))
            .collect();
        let destroys = |line: &Self, station: &usize| {
            line.controller(*station).error_state() == ErrorState::ErrorActive
        };
        let is_late = self.is_late(rate);
        let error = if strangers.iter().any(|other| destroys(self, other)) {
            Some(FrameError::OtherBitRate)
        } else if self.is_unlucky(rate) || self.is_slow(rate, others.len() + senders.len()) {
            Some(FrameError::Reflections)
        } else if !others.iter().any(same) || is_late {
            Some(FrameError::NoAcknowledge)
        } else {
            None
        };
        // The error flag of an active sender begins after the acknowledge slot and destroys the frame.
        let has_active = senders.iter().any(|sender| destroys(self, sender));
        let is_unheard = error == Some(FrameError::NoAcknowledge);
        let received = error.is_none() || is_unheard && is_late && !has_active;
        let sees_dominant = !is_unheard || has_active || !follows.is_empty();
        // A station that destroys a frame that all others accept was the first to see the error.
        let by = if others.iter().any(same) { 8 } else { 1 };
        for station in strangers {
            self.controllers[station].erred_receiving(by);
        }
        for sender in senders {
            let controller = &mut self.controllers[*sender];
            match error {
                None => controller.sent(),
                Some(_) if controller.transmit >= PASSIVE && !sees_dominant => {}
                Some(_) => controller.erred_sending(),
            }
        }
        for station in others.into_iter().filter(same) {
            if received {
                self.controllers[station].received();
            } else {
                self.controllers[station].erred_receiving(1);
            }
        }
        (error, received)
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
        (self.chance.number() >> 33) % 100 < percent
    }
}

/// The physics of the line.
#[cfg(feature = "training")]
impl Line {
    /// Returns whether a station cannot read a frame of another one because their clocks deviate.
    pub(super) fn misreads(&self, frame: &Frame, from: usize, to: usize) -> bool {
        self.cable.misreads(frame, from, to)
    }

    /// Sets a property of the line; a clock is that of this station.
    ///
    /// # Errors
    /// Never with the feature `training`.
    pub(crate) fn set_property(
        &mut self,
        station: usize,
        property: Property,
    ) -> Result<(), String> {
        self.cable.set(station, property);
        Ok(())
    }

    /// Returns a value of the line; a clock is that of this station.
    pub(crate) fn measure(&self, station: usize, measure: Measure) -> f64 {
        self.cable.measure(station, measure)
    }

    /// Returns whether CAN_H and CAN_L are connected, so that no bit can be dominant.
    pub(crate) fn is_shorted(&self) -> bool {
        self.cable.shorted
    }

    /// Returns whether acknowledgements come too late for the sender.
    fn is_late(&self, rate: Option<u16>) -> bool {
        self.cable.is_late(rate.unwrap_or(500))
    }

    /// Returns whether a recessive bit comes too late for all.
    fn is_slow(&self, rate: Option<u16>, stations: usize) -> bool {
        let rate = rate.unwrap_or(500);
        self.cable.is_slow(rate, self.terminators, stations)
    }
}

/// Without the feature `training` the line is short, and all clocks are right.
#[cfg(not(feature = "training"))]
impl Line {
    pub(super) fn misreads(&self, _: &Frame, _: usize, _: usize) -> bool {
        false
    }

    pub(crate) fn measure(&self, _: usize, _: Measure) -> f64 {
        0.0
    }

    pub(crate) fn set_property(&mut self, _: usize, _: Property) -> Result<(), String> {
        Err("this program has no physics of the line".into())
    }

    pub(crate) fn is_shorted(&self) -> bool {
        false
    }

    fn is_late(&self, _: Option<u16>) -> bool {
        false
    }

    fn is_slow(&self, _: Option<u16>, _: usize) -> bool {
        false
    }
}

/// Returns the first bit in which frames with one CAN-ID differ, and the frames whose bit is recessive there.
fn first_difference(frames: &[(usize, Frame)]) -> Option<(u64, Vec<(usize, Frame)>)> {
    let (_, first) = frames.first()?;
    if frames.iter().all(|(_, frame)| frame == first) {
        return None;
    }
    let all: Vec<Vec<bits::Bit>> = frames.iter().map(|(_, frame)| bits::bits(frame)).collect();
    let place = (0..all[0].len()).find(|place| {
        let level = |bits: &Vec<bits::Bit>| bits.get(*place).map(|bit| bit.recessive);
        all.iter().any(|bits| level(bits) != level(&all[0]))
    })?;
    let is_recessive = |bits: &Vec<bits::Bit>| bits.get(place).is_none_or(|bit| bit.recessive);
    let recessive = frames
        .iter()
        .zip(&all)
        .filter(|(_, bits)| is_recessive(bits));
    Some((place as u64, recessive.map(|(frame, _)| *frame).collect()))
}

/// Returns whether two stations have the same bit rate. A station without a bit rate adapts to all.
pub(crate) fn same_rate(one: Option<u16>, other: Option<u16>) -> bool {
    one.is_none() || other.is_none() || one == other
}

#[cfg(test)]
mod tests;
