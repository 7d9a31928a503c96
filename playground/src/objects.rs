//! The objects of a device.

use od_model::Address;
use od_sim::VirtualDevice;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::{packed, values};

#[wasm_bindgen]
impl Bus {
    /// The current value of an object as a master would read it, without a frame on the bus;
    /// `null` if the object does not exist.
    #[wasm_bindgen(unchecked_return_type = "Value")]
    pub fn read(&mut self, device: usize, index: u16, sub: u8) -> JsValue {
        let address = Address::new(index, sub);
        let value = self.journal.rig.with(device, |device, now| {
            let data_type = device.dictionary().find(address).ok()?.data_type;
            (device.is_powered() && is_known(device, address))
                .then(|| values::value(data_type, &device.read(address, now)))
        });
        value.flatten().unwrap_or(JsValue::NULL)
    }

    /// The objects whose value a power cycle would change, each as
    /// `index * 256 + sub`; with `saved`, those that are saved with their current value.
    pub fn unsaved(&mut self, device: usize, saved: bool) -> Vec<u32> {
        let look = |device: &mut VirtualDevice| {
            if !device.is_powered() || is_described(device) {
                return Vec::new();
            }
            let image = device.saved();
            let dictionary = device.dictionary();
            let of = |address: Address| device.is_unsaved(&image, address);
            let wanted = |address: &Address| of(*address) == Some(!saved);
            let addresses = dictionary.entries().iter().map(|entry| entry.address);
            addresses.filter(wanted).map(packed::object).collect()
        };
        self.journal
            .rig
            .with(device, |device, _| look(device))
            .unwrap_or_default()
    }

    /// Returns the value that an object will have at the next start: its saved value, or
    /// its default; `null` if the object is not saved.
    #[wasm_bindgen(js_name = savedValue, unchecked_return_type = "Value")]
    pub fn saved_value(&mut self, device: usize, index: u16, sub: u8) -> JsValue {
        let address = Address::new(index, sub);
        let look = |device: &mut VirtualDevice| {
            if is_described(device) {
                return None;
            }
            let mut saved = device.saved();
            let data_type = device.dictionary().find(address).ok()?.data_type;
            Some(values::value(data_type, &saved.bytes(device, address)?))
        };
        self.journal
            .rig
            .with(device, |device, _| look(device))
            .flatten()
            .unwrap_or(JsValue::NULL)
    }
}

/// Returns whether it describes a node of a real bus.
pub(crate) fn is_described(device: &VirtualDevice) -> bool {
    #[cfg(feature = "real")]
    return device.is_described();
    #[cfg(not(feature = "real"))]
    {
        let _ = device;
        false
    }
}

/// Returns whether the value at this address comes from the device, not from its file.
fn is_known(device: &VirtualDevice, address: Address) -> bool {
    #[cfg(feature = "real")]
    return device.is_known(address);
    #[cfg(not(feature = "real"))]
    {
        let _ = (device, address);
        true
    }
}
