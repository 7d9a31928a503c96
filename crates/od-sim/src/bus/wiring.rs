//! Shared properties of devices besides the bus: a shaft, a bit rate, and wires.

use std::prelude::v1::*;

/// Shafts of the devices, and which devices receive each other's frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Wiring {
    /// The shaft of each device: the number of the first device on it.
    shafts: Vec<usize>,
    /// Bit rate of the outside in kbit/s; `None`: bit rates do not matter.
    pub(super) rate: Option<u16>,
}

impl Wiring {
    /// Adds a device, on the shaft of another one or on its own.
    pub(super) fn add(&mut self, beside: Option<usize>) {
        let own = self.shafts.len();
        let shaft = beside.and_then(|other| self.shafts.get(other).copied());
        self.shafts.push(shaft.unwrap_or(own));
    }

    /// Removes a device; later ones move up. The others on its shaft stay together.
    pub(super) fn remove(&mut self, device: usize) {
        let heir = self.beside(device).first().copied();
        if device < self.shafts.len() {
            self.shafts.remove(device);
        }
        for shaft in &mut self.shafts {
            if *shaft == device {
                *shaft = heir.unwrap_or(device);
            }
            *shaft -= usize::from(*shaft > device);
        }
    }

    /// Gives a device a shaft of its own.
    pub(super) fn separate(&mut self, device: usize) {
        let heir = self.beside(device).first().copied();
        for (other, shaft) in self.shafts.iter_mut().enumerate() {
            if other == device {
                *shaft = device;
            } else if *shaft == device {
                *shaft = heir.unwrap_or(device);
            }
        }
    }

    /// The devices that sit on the shaft of this one, without it.
    pub(super) fn beside(&self, device: usize) -> Vec<usize> {
        let Some(shaft) = self.shafts.get(device) else {
            return Vec::new();
        };
        let all = self.shafts.iter().enumerate();
        all.filter(|(other, its)| *other != device && *its == shaft)
            .map(|(other, _)| other)
            .collect()
    }

    /// Returns whether two stations have the same bit rate. A device without a bit rate adapts to
    /// all.
    pub(super) fn hears(&self, one: Option<u16>, other: Option<u16>) -> bool {
        match (self.rate, one, other) {
            (Some(_), Some(one), Some(other)) => one == other,
            _ => true,
        }
    }
}

/// A wire, from a device and its connection to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wire {
    pub(super) from: (usize, usize),
    pub(super) to: (usize, usize),
    /// The last value on the wire.
    pub(super) last: Option<i64>,
}

impl Wire {
    /// Returns the wire after this device was removed from the bus; `None` if the wire was
    /// connected to it.
    pub(super) fn without(mut self, device: usize) -> Option<Self> {
        for (end, _) in [&mut self.from, &mut self.to] {
            if *end == device {
                return None;
            }
            *end -= usize::from(*end > device);
        }
        Some(self)
    }
}
