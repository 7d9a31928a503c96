//! Adds devices to a rig, and removes them.

use std::prelude::v1::*;

use od_runtime::DeviceKind;
use od_wire::NodeId;

use super::Rig;
use crate::device::VirtualDevice;

impl Rig {
    /// Adds a device to the bus, sets it up for the bit rate of the line, and switches it on. Returns
    /// its number. With a `place` it replaces the device with that number.
    pub fn put(&mut self, mut device: VirtualDevice, place: Option<usize>) -> usize {
        let devices = self.bus.devices();
        let others = (0..).zip(devices).filter(|(at, _)| Some(*at) != place);
        let rate = others.map(|(_, one)| one).find_map(VirtualDevice::bit_rate);
        device.set_up_for(self.bus.line.bit_rate.or(rate));
        #[cfg(feature = "real")]
        if self.describes {
            device = device.describing();
        }
        let number = match place.filter(|place| *place < self.bus.devices().len()) {
            Some(place) => {
                self.follow(place, &[], false);
                self.bus.replace(place, device);
                place
            }
            // Identical devices have different serial numbers, or LSS could not tell them apart.
            None => match self.bus.devices().len() {
                0 => self.bus.add(device),
                others => self.bus.add(device.with_serial_number(others as u32 + 1)),
            },
        };
        self.start(number);
        number
    }

    /// Adds a built-in device to the bus, as [`put`](Self::put) does. Further channels of a
    /// redundant encoder are nodes with the next node IDs on the same shaft, after all devices.
    pub fn put_kind(&mut self, kind: &DeviceKind, node_id: NodeId, place: Option<usize>) -> usize {
        let first = self.put(VirtualDevice::new(kind, node_id).delivered(), place);
        for channel in 1..kind.channels {
            let next = node_id.raw().checked_add(channel).and_then(NodeId::new);
            let mut device = VirtualDevice::new(kind, next.unwrap_or(NodeId::ONE))
                .with_serial_number(u32::from(channel) + 1)
                .delivered();
            let devices = self.bus.devices();
            device.set_up_for(devices.get(first).and_then(VirtualDevice::bit_rate));
            #[cfg(feature = "real")]
            if self.describes {
                device = device.describing();
            }
            let number = self.bus.add_beside(device, first);
            self.start(number);
        }
        first
    }

    fn start(&mut self, device: usize) {
        self.bus.start(device);
        self.collect_frames();
    }

    /// Removes a device from the bus; the numbers of later devices decrease by one.
    pub fn remove(&mut self, device: usize) {
        if self.bus.remove(device).is_some() {
            self.clockwork.remove(device);
        }
    }

    /// Switches the power of a device.
    pub fn set_power(&mut self, device: usize, on: bool) {
        let act = if on {
            VirtualDevice::power_on
        } else {
            VirtualDevice::power_off
        };
        self.with(device, act);
    }
}
