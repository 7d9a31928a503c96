//! A copy of a bus, to start from the same moment more than once.

use std::prelude::v1::*;

use super::Bus;

impl Bus {
    /// Returns a copy that goes on as this bus would. `None` if a device [cannot be
    /// copied](crate::VirtualDevice::copy).
    pub fn copy(&self) -> Option<Self> {
        let devices = self.devices.iter().map(|device| device.copy());
        Some(Self {
            devices: devices.collect::<Option<Vec<_>>>()?,
            wiring: self.wiring.clone(),
            line: self.line.clone(),
            now: self.now,
            sent: self.sent.clone(),
        })
    }
}
