//! Several devices on one bus, in virtual time.

mod pins;
mod run;
mod traffic;
mod wiring;

use std::collections::VecDeque;
use std::prelude::v1::*;

use od_runtime::{BusEvent, Frame, Instant};

use crate::bus::wiring::{Wire, Wiring};
use crate::device::VirtualDevice;
use crate::wire::{Line, Station};

/// A frame that a device on the bus sent, or on a real line the outside.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sent {
    /// Time of the frame.
    pub at: Instant,
    /// Number of the device, counted from 0 in the order of [`Bus::add`]; `None` for one from outside,
    /// when it came through a real line.
    pub device: Option<usize>,
    /// The frame.
    pub frame: Frame,
}

/// On an ideal line a frame reaches everybody at the moment it is sent, or everybody
/// with the same bit rate where [`set_bit_rate`](Bus::set_bit_rate) says that it matters. A
/// real [`line`](Bus::line) lets frames fail as CAN does, and each takes its bits.
///
/// Events of one moment have a fixed order: devices in the order they
/// were added, frames in the order they were sent. The same inputs give the same
/// frames on every run. A copy continues as this bus would.
#[derive(Clone, Default)]
pub struct Bus {
    devices: Vec<VirtualDevice>,
    wiring: Wiring,
    wires: Vec<Wire>,
    /// The wire; ideal unless it is set to real.
    pub line: Line,
    now: Instant,
    sent: VecDeque<Sent>,
}

/// How often in a row a device may have a deadline that is already due; after that the
/// bus moves on by a microsecond, so that no device can stop time.
const STUCK: u32 = 1000;

impl Bus {
    /// A bus without devices, at the origin of time.
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts a device on the bus; answers with its number. It may be powered or not.
    pub fn add(&mut self, device: VirtualDevice) -> usize {
        self.put(device, None)
    }

    /// As [`add`](Self::add), on the shaft of a device that is there already: when one of
    /// them turns, all do, with or without power.
    pub fn add_beside(&mut self, device: VirtualDevice, other: usize) -> usize {
        self.put(device, Some(other))
    }

    fn put(&mut self, device: VirtualDevice, beside: Option<usize>) -> usize {
        self.devices.push(device);
        self.wiring.add(beside);
        let added = self.devices.len() - 1;
        if let Some(other) = beside {
            self.turn_along(other);
        }
        self.settle(added);
        added
    }

    /// Takes a device off the bus; those behind it move up by one.
    pub fn remove(&mut self, device: usize) -> Option<VirtualDevice> {
        if device >= self.devices.len() {
            return None;
        }
        self.line.remove(device + 1);
        self.wiring.remove(device);
        self.cut_wires(device);
        Some(self.devices.remove(device))
    }

    /// Puts another device in the place of one, on a shaft of its own; answers whether there
    /// is such a place.
    pub fn replace(&mut self, place: usize, device: VirtualDevice) -> bool {
        let Some(old) = self.devices.get_mut(place) else {
            return false;
        };
        *old = device;
        self.wiring.separate(place);
        self.cut_wires_of(place);
        self.line.restart(place + 1);
        self.settle(place);
        true
    }

    /// Starts the CAN controller of a station again: 0 is the outside, devices count from 1.
    /// A device decides itself what it makes of that after bus-off.
    pub fn restart_controller(&mut self, station: usize) {
        self.line.restart(station);
        if let Some(device) = station.checked_sub(1) {
            self.with(device, |device, now| {
                device.handle_bus(BusEvent::Active, now)
            });
        }
    }

    /// Power comes for the first time. Time on a bench begins when its devices boot up, so at the
    /// origin of time this is the moment of the boot-up; later, the initialisation takes the time
    /// that it takes after every power-on.
    pub fn start(&mut self, device: usize) {
        self.set_power(device, true);
        if self.now == Instant::ZERO {
            for channel in self.behind_connector(device) {
                self.with(channel, VirtualDevice::boot_at_once);
            }
        }
    }

    /// Power comes or goes. The channels of one device have one connector, so all of them get
    /// it or lose it.
    pub fn set_power(&mut self, device: usize, on: bool) {
        let act = if on {
            VirtualDevice::power_on
        } else {
            VirtualDevice::power_off
        };
        for channel in self.behind_connector(device) {
            self.with(channel, act);
        }
    }

    /// Returns the channels that share the connector of a device, itself included.
    fn behind_connector(&self, device: usize) -> Vec<usize> {
        let Some(one) = self.devices.get(device) else {
            return Vec::new();
        };
        let mut all = match one.channels() {
            0 | 1 => Vec::new(),
            _ => self.wiring.beside(device),
        };
        all.retain(|other| self.devices[*other].channels() > 1);
        let at = all.partition_point(|other| *other < device);
        all.insert(at, device);
        all
    }

    /// The devices on the shaft of this one follow it.
    fn turn_along(&mut self, device: usize) {
        let Some(shaft) = self.devices.get(device).and_then(VirtualDevice::shaft_now) else {
            return;
        };
        for other in self.wiring.beside(device) {
            self.devices[other].put_on_shaft(&shaft, self.now);
            self.settle(other);
        }
    }

    /// The bit rate of what is outside in kbit/s. From now on a device with another one
    /// neither hears nor is heard, not by the other devices either; `None`, as it is at
    /// first: everybody hears everybody.
    pub fn set_bit_rate(&mut self, kbit: Option<u16>) {
        self.wiring.rate = kbit;
    }

    /// The bit rate of what is outside in kbit/s, where it matters.
    pub fn bit_rate(&self) -> Option<u16> {
        self.wiring.rate
    }

    /// Does what is outside hear this device, and the device what is outside?
    fn hears_outside(&self, device: usize) -> bool {
        if self.wiring.rate.is_none() {
            return true;
        }
        let rate = self.devices[device].bit_rate();
        self.wiring.hears(self.wiring.rate, rate)
    }

    /// The devices, in the order they were added.
    pub fn devices(&self) -> &[VirtualDevice] {
        &self.devices
    }

    /// The present moment.
    pub fn now(&self) -> Instant {
        self.now
    }

    /// Does something with a device at the present moment (power, shaft, faults …) and takes
    /// the frames that it sends because of that. `None` if the device does not exist.
    pub fn with<R>(
        &mut self,
        device: usize,
        act: impl FnOnce(&mut VirtualDevice, Instant) -> R,
    ) -> Option<R> {
        let (mut act, mut result) = (Some(act), None);
        self.with_it(device, &mut |one, now| {
            result = act.take().map(|act| act(one, now));
        });
        result
    }

    /// As [`with`](Self::with), once for all types of results.
    fn with_it(&mut self, device: usize, act: &mut dyn FnMut(&mut VirtualDevice, Instant)) {
        let now = self.now;
        let Some(one) = self.devices.get_mut(device) else {
            return;
        };
        let before = one.shaft_now();
        let was_powered = one.is_powered();
        act(one, now);
        let turned = one.shaft_now() != before;
        if one.is_powered() && !was_powered {
            self.line.restart(device + 1);
        }
        if !one.is_powered() {
            self.line.medium.forget(device + 1);
        }
        self.settle(device);
        if turned {
            self.turn_along(device);
        }
        self.conduct();
        self.tell_controllers();
    }

    /// A frame from outside: every device receives it, and each other's answers. Answers
    /// whether the line let it through. On a real line it only waits for its turn now, and is
    /// [polled](Self::poll) when it came through.
    pub fn receive(&mut self, frame: &Frame) -> bool {
        if self.line.is_real() {
            self.queue(frame);
            return false;
        }
        if !self.line.is_plugged(0) {
            return false;
        }
        for device in 0..self.devices.len() {
            if self.hears_outside(device) && self.line.is_plugged(device + 1) {
                self.devices[device].handle_frame(self.now, frame);
                self.settle(device);
            }
        }
        self.conduct();
        true
    }

    /// The outside and the devices, as a real line sees them.
    fn stations(&self) -> Vec<Station> {
        let outside = Station {
            present: true,
            rate: None,
        };
        let device = |device: &VirtualDevice| Station {
            present: device.is_powered(),
            rate: device.bit_rate(),
        };
        let mut all: Vec<_> = core::iter::once(outside)
            .chain(self.devices.iter().map(device))
            .collect();
        all[0].rate = self.line.outside_rate(&all);
        all
    }

    /// Controllers whose condition changed tell their devices.
    fn tell_controllers(&mut self) {
        while let Some((station, event)) = self.line.poll_event() {
            let Some(device) = station.checked_sub(1).filter(|at| *at < self.devices.len()) else {
                continue;
            };
            self.devices[device].handle_bus(event, self.now);
            self.settle(device);
        }
    }

    /// Time passes until `to`; deadlines on the way are met at their own moment.
    pub fn advance(&mut self, to: Instant) {
        while self.step(to) {}
    }

    /// The next frame that a device sent, oldest first.
    pub fn poll(&mut self) -> Option<Sent> {
        self.sent.pop_front()
    }

    /// Meets the next deadline not after `to`, if there is one; else it is `to` now.
    fn step(&mut self, to: Instant) -> bool {
        let goes_on = self.step_without_wires(to);
        self.conduct();
        goes_on
    }

    fn step_without_wires(&mut self, to: Instant) -> bool {
        let due = (0..self.devices.len())
            .filter_map(|device| Some((self.deadline(device)?, device)))
            .min();
        if let Some(at) = self.line.medium.due()
            && at <= to
            && due.is_none_or(|(first, _)| at <= first)
        {
            self.now = self.now.max(at);
            self.carry();
            return true;
        }
        if let Some((at, device)) = self.line.next_recovery()
            && at <= to
            && due.is_none_or(|(first, _)| at < first)
        {
            self.now = self.now.max(at);
            self.recover(device);
            return true;
        }
        let Some((at, device)) = due.filter(|(at, _)| *at <= to) else {
            self.now = self.now.max(to);
            return false;
        };
        self.now = self.now.max(at);
        self.meet(device, 0, to)
    }

    /// Meets the deadlines of a device at this moment, of which `met` were met already. Returns whether it
    /// is not after `to` now.
    fn meet(&mut self, device: usize, met: u32, to: Instant) -> bool {
        for _ in met..STUCK {
            self.devices[device].handle_timeout(self.now);
            self.settle(device);
            self.tell_controllers();
            match self.deadline(device) {
                Some(again) if again <= self.now => {}
                _ => return true,
            }
        }
        self.now = self.now.plus_micros(1);
        self.now <= to
    }

    /// The bus has been recessive for long enough: a device that restarts its controller after
    /// bus-off is back; one that does not stays off.
    fn recover(&mut self, device: usize) {
        let begins = self.devices.get_mut(device).is_some_and(|one| {
            one.handle_bus(BusEvent::Active, self.now);
            !one.is_bus_off()
        });
        self.line.recover(device, begins);
        if begins {
            self.settle(device);
            self.tell_controllers();
        }
    }

    /// Takes what a device sends and hands it to the others, whose answers in turn …
    fn settle(&mut self, device: usize) {
        if self.line.is_real() {
            return self.load(device, self.now);
        }
        let mut carry = VecDeque::new();
        self.collect(device, &mut carry);
        // Two devices that answer each other for ever would be a broken pair; stop there.
        for _ in 0..STUCK {
            let Some((from, frame)) = carry.pop_front() else {
                return;
            };
            let rate = self.devices[from].bit_rate();
            for other in (0..self.devices.len()).filter(|other| *other != from) {
                let its = self.devices[other].bit_rate();
                if !self.wiring.hears(rate, its) || !self.line.is_plugged(other + 1) {
                    continue;
                }
                self.devices[other].handle_frame(self.now, &frame);
                self.collect(other, &mut carry);
            }
        }
    }

    fn collect(&mut self, device: usize, carry: &mut VecDeque<(usize, Frame)>) {
        while let Some(frame) = self.devices[device].poll_transmit(self.now) {
            if !self.line.is_plugged(device + 1) {
                continue;
            }
            // A device may change its bit rate with what it sent last, so it is asked each time.
            if self.hears_outside(device) && self.line.is_plugged(0) {
                self.sent.push_back(Sent {
                    at: self.now,
                    device: Some(device),
                    frame,
                });
            }
            if self.devices.len() > 1 {
                carry.push_back((device, frame));
            }
        }
    }
}
