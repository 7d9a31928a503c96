//! Several devices on one bus, in virtual time.

#[cfg(feature = "training")]
mod master;
mod run;
mod shafts;
mod traffic;
mod wires;

use std::collections::VecDeque;
use std::prelude::v1::*;

use od_runtime::{BusEvent, Frame, Instant};

use crate::bus::shafts::Shafts;
use crate::device::VirtualDevice;
use crate::line::{Line, Station, same_rate};

/// A frame that a device on the bus sent; on a real line also one from outside.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Sent {
    /// Time of the frame.
    pub at: Instant,
    /// Number of the device, counted from 0 in the order of [`Bus::add`]; `None` for a frame from
    /// outside that was sent over a real line, or of the master.
    pub device: Option<usize>,
    /// The frame.
    pub frame: Frame,
}

/// Devices on one CAN bus, in virtual time.
///
/// On an ideal line all stations receive a frame at the moment when it is sent, or all stations
/// with the same bit rate after [`set_bit_rate`](Bus::set_bit_rate). On a real [`line`](Bus::line)
/// a frame takes the time of its bits, and can fail as on CAN.
///
/// Events of one moment have a fixed order: devices in the order in which they were added, frames
/// in the order in which they were sent. The same inputs give the same frames on every run, and a
/// copy continues as the original would.
#[derive(Clone, Default)]
pub struct Bus {
    devices: Vec<VirtualDevice>,
    shafts: Shafts,
    wires: Vec<Wire>,
    /// Bit rate of the outside in kbit/s; `None`: bit rates do not matter.
    rate: Option<u16>,
    /// The bus line; ideal unless it is set to real.
    pub line: Line,
    now: Instant,
    sent: VecDeque<Sent>,
    #[cfg(feature = "training")]
    master: Option<Box<crate::master::Master>>,
    /// Frames of the master that the host has not polled yet.
    #[cfg(all(feature = "training", feature = "serve"))]
    of_master: VecDeque<Frame>,
}

/// A wire from one connection to another. Each end is the number of a device, and of its connection.
#[derive(Clone, Copy, Debug)]
struct Wire {
    from: (usize, usize),
    to: (usize, usize),
    /// The last value that was passed on; `None` before the first.
    last: Option<i64>,
}

/// Longest wait for the end of the traffic on a real line, in microseconds: a line that is full never becomes quiet.
pub(crate) const UNTIL_QUIET: u64 = 100_000;

/// Limit of rounds at one moment: devices, wires or the master that react to each other without end must not stop time.
const STUCK: u32 = 1000;

impl Bus {
    /// A bus without devices, at the origin of time.
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts a device with or without power on the bus, and returns its number.
    pub fn add(&mut self, device: VirtualDevice) -> usize {
        self.put(device, None)
    }

    /// As [`add`](Self::add), but on the shaft of an existing device: when one of them turns, all
    /// do, with or without power.
    pub fn add_beside(&mut self, device: VirtualDevice, other: usize) -> usize {
        self.put(device, Some(other))
    }

    fn put(&mut self, device: VirtualDevice, beside: Option<usize>) -> usize {
        self.devices.push(device);
        self.shafts.add(beside);
        let added = self.devices.len() - 1;
        if let Some(other) = beside {
            self.turn_along(other);
        }
        self.pass_on(added);
        added
    }

    /// Removes a device from the bus; the numbers of later devices decrease by one.
    pub fn remove(&mut self, device: usize) -> Option<VirtualDevice> {
        if device >= self.devices.len() {
            return None;
        }
        self.line.remove(device + 1);
        self.shafts.remove(device);
        self.cut_wires(device);
        Some(self.devices.remove(device))
    }

    /// Replaces a device by another one with a shaft of its own. Returns whether the place exists.
    pub fn replace(&mut self, place: usize, device: VirtualDevice) -> bool {
        let Some(old) = self.devices.get_mut(place) else {
            return false;
        };
        *old = device;
        self.shafts.separate(place);
        self.cut_wires_of(place);
        self.line.restart(place + 1);
        self.pass_on(place);
        true
    }

    /// Restarts the CAN controller of a station: 0 is the outside, devices count from 1. After
    /// bus-off the device decides whether it returns to the bus.
    pub fn restart_controller(&mut self, station: usize) {
        self.line.restart(station);
        if let Some(device) = station.checked_sub(1) {
            self.with(device, |device, now| {
                device.handle_bus(BusEvent::Active, now)
            });
        }
    }

    /// Switches the power on for the first time. At time 0 the device boots up at once; later its
    /// initialisation takes the same time as after any power-on.
    pub fn start(&mut self, device: usize) {
        self.set_power(device, true);
        if self.now == Instant::ZERO {
            for channel in self.behind_connector(device) {
                self.with(channel, VirtualDevice::boot_at_once);
            }
        }
    }

    /// Switches the power of a device, with all its channels, since they share one connector.
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
            _ => self.shafts.beside(device),
        };
        all.retain(|other| self.devices[*other].channels() > 1);
        let at = all.partition_point(|other| *other < device);
        all.insert(at, device);
        all
    }

    /// Turns the devices on the same shaft, too.
    fn turn_along(&mut self, device: usize) {
        let Some(shaft) = self.devices.get(device).and_then(VirtualDevice::shaft_now) else {
            return;
        };
        for other in self.shafts.beside(device) {
            self.devices[other].put_on_shaft(&shaft, self.now);
            self.pass_on(other);
        }
    }

    /// Sets the bit rate of the outside in kbit/s. From now on a device with another bit rate and
    /// all others do not receive each other's frames. `None`, the initial state: all stations
    /// receive all frames.
    pub fn set_bit_rate(&mut self, kbit: Option<u16>) {
        self.rate = kbit;
    }

    /// The bit rate of the outside in kbit/s; `None`: bit rates do not matter.
    pub fn bit_rate(&self) -> Option<u16> {
        self.rate
    }

    /// Returns whether this device and the outside receive each other's frames.
    fn hears_outside(&self, device: usize) -> bool {
        self.rate.is_none() || same_rate(self.rate, self.devices[device].bit_rate())
    }

    /// Returns whether devices with these bit rates receive each other's frames, see
    /// [`set_bit_rate`](Self::set_bit_rate).
    fn hears(&self, one: Option<u16>, other: Option<u16>) -> bool {
        self.rate.is_none() || same_rate(one, other)
    }

    /// The devices, in the order in which they were added.
    pub fn devices(&self) -> &[VirtualDevice] {
        &self.devices
    }

    /// The present moment.
    pub fn now(&self) -> Instant {
        self.now
    }

    /// Calls `act` with a device at the present time (power, shaft, faults …), and collects the
    /// frames that it sends because of that. `None` if the device does not exist.
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

    /// As [`with`](Self::with), compiled once for all result types.
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
        self.pass_on(device);
        if turned {
            self.turn_along(device);
        }
        self.follow_wires();
        self.report_controllers();
        self.run_master();
    }

    /// Sends a frame from outside. On an ideal line every device receives it at once, then the responses of
    /// the others. On a real line the frame waits for the line, and is [polled](Self::poll) after its transmission.
    ///
    /// Returns whether the devices have received it: `false` on a real line, and while the outside is not connected.
    pub fn receive(&mut self, frame: &Frame) -> bool {
        if self.line.is_real() {
            self.queue(frame);
            return false;
        }
        if !self.line.is_plugged(0) {
            return false;
        }
        self.hand_over(frame);
        self.follow_wires();
        self.run_master();
        true
    }

    /// Hands a frame of the outside to the devices on an ideal line.
    fn hand_over(&mut self, frame: &Frame) {
        for device in 0..self.devices.len() {
            if self.hears_outside(device) && self.line.is_plugged(device + 1) {
                self.devices[device].handle_frame(self.now, frame);
                self.pass_on(device);
            }
        }
    }

    /// The outside and the devices, as stations of a real line.
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

    /// Tells devices whose controllers changed their state.
    fn report_controllers(&mut self) {
        while let Some((station, event)) = self.line.poll_event() {
            let Some(device) = station.checked_sub(1).filter(|at| *at < self.devices.len()) else {
                continue;
            };
            self.devices[device].handle_bus(event, self.now);
            self.pass_on(device);
        }
    }

    /// The next frame that a device sent, oldest first.
    pub fn poll(&mut self) -> Option<Sent> {
        self.sent.pop_front()
    }

    /// All frames of devices, oldest first.
    pub(crate) fn poll_all(&mut self) -> impl Iterator<Item = Sent> + '_ {
        self.sent.drain(..)
    }

    /// Collects the frames of a device and passes them to the others, then the responses of those in the
    /// same way.
    fn pass_on(&mut self, device: usize) {
        if self.line.is_real() {
            return self.load(device, self.now);
        }
        let mut carry = VecDeque::new();
        self.collect(device, &mut carry);
        // Two devices that respond to each other without end are broken; stop there.
        for _ in 0..STUCK {
            let Some((from, frame)) = carry.pop_front() else {
                return;
            };
            let rate = self.devices[from].bit_rate();
            for other in (0..self.devices.len()).filter(|other| *other != from) {
                let its = self.devices[other].bit_rate();
                if !self.hears(rate, its) || !self.line.is_plugged(other + 1) {
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
            // A device may change its bit rate after its last frame, so it is asked each time.
            if self.hears_outside(device) && self.line.is_plugged(0) {
                self.sent.push_back(Sent {
                    at: self.now,
                    device: Some(device),
                    frame,
                });
                self.tell_master(&frame);
            }
            if self.devices.len() > 1 {
                carry.push_back((device, frame));
            }
        }
    }
}

/// Without the feature `training` a bus has no master.
#[cfg(not(feature = "training"))]
impl Bus {
    pub(crate) fn order_master(&mut self, _: &crate::master::Order) -> Result<(), String> {
        Err("this program has no master".into())
    }

    pub(crate) fn boot_state(&self, _: od_wire::NodeId) -> Option<crate::master::BootState> {
        None
    }

    fn master_due(&self) -> Option<Instant> {
        None
    }

    fn has_master(&self) -> bool {
        false
    }

    fn tell_master(&mut self, _: &Frame) {}

    fn run_master(&mut self) {}

    #[cfg(feature = "serve")]
    pub(crate) fn take_of_master(&mut self, _: &Frame) -> bool {
        false
    }
}
