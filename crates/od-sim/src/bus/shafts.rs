//! Devices that share a shaft, such as the channels of a redundant encoder.

use std::prelude::v1::*;

/// The shaft of each device, by the number of the first device on it.
#[derive(Clone, Debug, Default)]
pub(super) struct Shafts(Vec<usize>);

impl Shafts {
    /// Adds a device, on the shaft of another one or on its own.
    pub(super) fn add(&mut self, beside: Option<usize>) {
        let own = self.0.len();
        let shaft = beside.and_then(|other| self.0.get(other).copied());
        self.0.push(shaft.unwrap_or(own));
    }

    /// Removes a device; later ones move up. The others on its shaft stay together.
    pub(super) fn remove(&mut self, device: usize) {
        let heir = self.beside(device).first().copied();
        if device < self.0.len() {
            self.0.remove(device);
        }
        for shaft in &mut self.0 {
            if *shaft == device {
                *shaft = heir.unwrap_or(device);
            }
            *shaft -= usize::from(*shaft > device);
        }
    }

    /// Gives a device a shaft of its own.
    pub(super) fn separate(&mut self, device: usize) {
        let heir = self.beside(device).first().copied();
        for (other, shaft) in self.0.iter_mut().enumerate() {
            if other == device {
                *shaft = device;
            } else if *shaft == device {
                *shaft = heir.unwrap_or(device);
            }
        }
    }

    /// The devices that sit on the shaft of this one, without it.
    pub(super) fn beside(&self, device: usize) -> Vec<usize> {
        let Some(shaft) = self.0.get(device) else {
            return Vec::new();
        };
        let all = self.0.iter().enumerate();
        all.filter(|(other, its)| *other != device && *its == shaft)
            .map(|(other, _)| other)
            .collect()
    }
}
