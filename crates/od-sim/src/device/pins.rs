//! Connections of a device to the world beside its bus, by name.

use std::format;
use std::prelude::v1::*;

use od_model::Refused;
use od_runtime::encoder::Angle;
use od_runtime::{Application, Instant, Pin, PinKind};

use crate::device::VirtualDevice;

/// The pin of an encoder: the angle of its shaft from the sensor's zero point, in 2⁻³² revolutions.
const SHAFT: &[Pin] = &[Pin::input("shaft")];

impl VirtualDevice {
    /// The connections of this device.
    pub fn pins(&self) -> &'static [Pin] {
        match self.encoder() {
            Some(_) => SHAFT,
            None => self.node.application.pins(),
        }
    }

    /// Number of the connection with this name.
    ///
    /// # Errors
    /// A sentence that names those that the device has.
    pub(crate) fn pin_named(&self, name: &str) -> Result<usize, Refused> {
        let pins = self.pins();
        let found = pins.iter().position(|pin| pin.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = pins.iter().map(|pin| pin.name).collect();
            match names.as_slice() {
                [] => "this device has no connections".into(),
                names => format!(
                    "this device has no connection `{name}`; it has {}",
                    names.join(", ")
                )
                .into(),
            }
        })
    }

    /// The value at a connection, by its number in [`pins`](Self::pins).
    pub fn pin(&self, number: usize, now: Instant) -> i64 {
        let Some(pin) = self.pins().get(number) else {
            return 0;
        };
        match self.encoder() {
            Some(encoder) => encoder.shaft.seen(now).fractions(),
            None if pin.kind == PinKind::Output && !self.is_powered() => 0,
            None => self.node.application.pin(number),
        }
    }

    /// Sets an input, by its number in [`pins`](Self::pins), and lets the device notice; other connections
    /// stay as they are. A shaft that is set at least every 20 ms turns.
    pub fn set_pin(&mut self, number: usize, value: i64, now: Instant) {
        let kind = self.pins().get(number).map(|pin| pin.kind);
        if kind != Some(PinKind::Input) {
            return;
        }
        match self.node.application.encoder_mut() {
            Some(encoder) => encoder.shaft.place(now, Angle::from_fractions(value)),
            None => self.node.application.set_pin(number, value),
        }
        self.noticed(now);
    }
}
