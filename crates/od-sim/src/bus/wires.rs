//! Wires between connections of devices beside the bus: an output sets an input.

use std::format;
use std::prelude::v1::*;

use od_model::Refused;
use od_runtime::PinKind;

use super::{Bus, STUCK, Wire};

impl Wire {
    /// Returns the wire after this device was removed from the bus; `None` if the wire was
    /// connected to it.
    fn without(mut self, device: usize) -> Option<Self> {
        for (end, _) in [&mut self.from, &mut self.to] {
            if *end == device {
                return None;
            }
            *end -= usize::from(*end > device);
        }
        Some(self)
    }
}

impl Bus {
    /// Wires the connection of a device to an input of a device, which may be the same. An input
    /// has one wire; a new one replaces it.
    ///
    /// # Errors
    /// A message: a device or a connection does not exist, or the second one is not an input.
    pub fn connect(&mut self, from: (usize, &str), to: (usize, &str)) -> Result<(), Refused> {
        let pin = |(device, name): (usize, &str)| {
            let one = self
                .devices
                .get(device)
                .ok_or_else(|| Refused::from(format!("device {} does not exist", device + 1)))?;
            let number = one.pin_named(name)?;
            Ok::<_, Refused>(((device, number), one.pins()[number].kind))
        };
        let (from, _) = pin(from)?;
        let name = to.1;
        let (to, kind) = pin(to)?;
        if kind != PinKind::Input {
            return Err(format!("`{name}` is not an input").into());
        }
        self.wires.retain(|wire| wire.to != to);
        self.wires.push(Wire {
            from,
            to,
            last: None,
        });
        self.follow_wires();
        Ok(())
    }

    /// Passes the values that changed at the first end of each wire to its second end.
    pub(super) fn follow_wires(&mut self) {
        if self.wires.is_empty() {
            return;
        }
        // Two outputs that follow each other without end are an oscillator; stop there.
        for _ in 0..STUCK {
            let mut is_changed = false;
            for at in 0..self.wires.len() {
                let Wire { from, to, last } = self.wires[at];
                let value = self.devices[from.0].pin(from.1, self.now);
                if last == Some(value) {
                    continue;
                }
                self.wires[at].last = Some(value);
                self.devices[to.0].set_pin(to.1, value, self.now);
                self.pass_on(to.0);
                is_changed = true;
            }
            if !is_changed {
                return;
            }
        }
    }

    /// Removes the wires of a device that leaves the bus; later devices move up.
    pub(super) fn cut_wires(&mut self, device: usize) {
        let wires = core::mem::take(&mut self.wires);
        let left = wires.into_iter().filter_map(|wire| wire.without(device));
        self.wires = left.collect();
    }

    /// Removes the wires of a device that is replaced.
    pub(super) fn cut_wires_of(&mut self, place: usize) {
        self.wires
            .retain(|wire| wire.from.0 != place && wire.to.0 != place);
    }
}
