//! Connections of a device to the world beside its bus.

use od_runtime::PinKind;
use od_sim::VirtualDevice;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Crosses, record};

record! {
    /// A connection of a device to the world beside its bus.
    Pin {
        name: &'static str,
        /// Whether the world sets it; otherwise the device does.
        input: bool,
        value: f64,
    }
}

#[wasm_bindgen]
impl Bus {
    /// The connections of a device, with their values.
    #[wasm_bindgen(unchecked_return_type = "Pin[]")]
    pub fn pins(&mut self, device: usize) -> Vec<JsValue> {
        let look = |device: &mut VirtualDevice, now| {
            let pins = device.pins().iter().enumerate();
            pins.map(|(number, pin)| Pin {
                name: pin.name,
                input: pin.kind == PinKind::Input,
                value: device.pin(number, now) as f64,
            })
            .collect()
        };
        let pins: Vec<Pin> = self.journal.rig.with(device, look).unwrap_or_default();
        pins.into_iter().map(Crosses::value).collect()
    }
}
