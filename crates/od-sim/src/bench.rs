//! A bus with names for its devices, and the device that lines without a name are about.

use std::format;
use std::prelude::v1::*;

use od_runtime::Instant;

use crate::bus::Bus;
use crate::device::VirtualDevice;

/// A bus, with the names that scripts gave to its devices.
#[derive(Clone, Default)]
pub struct Bench {
    /// The bus.
    pub bus: Bus,
    pub(crate) labels: Vec<Option<String>>,
    /// The device that lines without a name are about, counted from 0.
    pub(crate) current: usize,
}

impl Bench {
    /// A bench for a bus whose devices have only numbers, counted from 1.
    pub fn new(bus: Bus) -> Self {
        let labels = bus.devices().iter().map(|_| None).collect();
        Self {
            bus,
            labels,
            current: 0,
        }
    }

    /// Returns the number, counted from 0, of the device with this label; `name.1` is the first
    /// channel of a redundant device. If no label matches, it is the device with this number,
    /// counted from 1.
    pub fn device(&self, name: &str) -> Option<usize> {
        let find = |name: &str| {
            let mut labels = self.labels.iter();
            labels.position(|label| label.as_deref() == Some(name))
        };
        let number = || {
            let number: usize = name.parse().ok()?;
            (1..=self.bus.devices().len())
                .contains(&number)
                .then(|| number - 1)
        };
        find(name)
            .or_else(|| find(name.strip_suffix(".1")?))
            .or_else(number)
    }

    /// As [`device`](Self::device).
    ///
    /// # Errors
    /// If no device has this name: a message that lists the devices on the bus.
    pub(crate) fn named(&self, name: &str) -> Result<usize, String> {
        self.device(name).ok_or_else(|| {
            let count = self.bus.devices().len();
            format!(
                "device `{name}` does not exist; write its number, 1 to {count}, or the name \
                 after `as` in its `device` line"
            )
        })
    }

    /// The current device.
    ///
    /// # Errors
    /// It was removed from the bus.
    pub(crate) fn present(&self) -> Result<&VirtualDevice, String> {
        let device = self.bus.devices().get(self.current);
        device.ok_or_else(|| self.missing())
    }

    /// Calls `act` with the current device.
    ///
    /// # Errors
    /// It was removed from the bus.
    pub(crate) fn with<R>(
        &mut self,
        act: impl FnOnce(&mut VirtualDevice, Instant) -> R,
    ) -> Result<R, String> {
        let result = self.bus.with(self.current, act);
        result.ok_or_else(|| self.missing())
    }

    fn missing(&self) -> String {
        format!("device {} does not exist", self.current + 1)
    }
}
