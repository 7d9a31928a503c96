//! What hangs on the bus.

#[cfg(feature = "eds")]
use od_bench::VirtualDevice;
use od_runtime::{DeviceKind, NodeId};
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
#[cfg(feature = "eds")]
use crate::eds::diagnostics;
use crate::record::Record;

#[wasm_bindgen]
impl Bus {
    /// Puts a device of ours on the bus and gives it power; answers with its number.
    /// `builtinDevices` lists the names. With a `place` it takes the place of the device
    /// with that number. A redundant encoder puts its further channels behind all devices.
    ///
    /// # Errors
    /// Where there is no such device, or the node ID is not 1 to 127.
    #[wasm_bindgen(js_name = addDevice)]
    pub fn add_device(
        &mut self,
        name: &str,
        node_id: u8,
        place: Option<usize>,
    ) -> Result<usize, JsError> {
        let node_id = valid(node_id)?;
        let kind = od_devices::find(name)
            .ok_or_else(|| JsError::new(&format!("there is no device `{name}`")))?;
        Ok(self.rig.put_kind(kind, node_id, place))
    }

    /// Puts the device that an EDS or DCF text describes on the bus and gives it power.
    /// The answer has its number, or `null` and what is wrong with the text. A lenient bus
    /// runs what can be run of a text with errors.
    ///
    /// # Errors
    /// Where the node ID is not 1 to 127.
    #[cfg(feature = "eds")]
    #[wasm_bindgen(js_name = addEds, unchecked_return_type = "EdsResult")]
    pub fn add_eds(
        &mut self,
        text: &str,
        node_id: u8,
        lenient: Option<bool>,
        place: Option<usize>,
    ) -> Result<JsValue, JsError> {
        let options = od_bench::EdsOptions {
            node_id: Some(valid(node_id)?),
            lenient: lenient.unwrap_or_default(),
        };
        let (device, found) = VirtualDevice::read_eds(text, options);
        let device = device.map_or(JsValue::NULL, |device| {
            JsValue::from_f64(self.rig.put(device, place) as f64)
        });
        Ok(Record::new()
            .with("device", device)
            .with("diagnostics", diagnostics(&found, text))
            .done())
    }

    /// How many devices are on the bus.
    #[wasm_bindgen(js_name = deviceCount)]
    pub fn device_count(&self) -> usize {
        self.rig.bus.devices().len()
    }

    /// Takes a device off the bus; the numbers of those behind it go down by one.
    #[wasm_bindgen(js_name = removeDevice)]
    pub fn remove_device(&mut self, device: usize) {
        self.rig.remove(device);
    }

    /// A name for people.
    pub fn title(&self, device: usize) -> String {
        self.rig
            .bus
            .devices()
            .get(device)
            .map(|device| device.title().into())
            .unwrap_or_default()
    }

    /// The active node ID.
    #[wasm_bindgen(js_name = nodeId)]
    pub fn node_id(&self, device: usize) -> u8 {
        self.rig
            .bus
            .devices()
            .get(device)
            .map_or(0, |device| device.node_id().raw())
    }
}

/// The devices that `Bus.addDevice` knows.
#[wasm_bindgen(js_name = builtinDevices, unchecked_return_type = "Builtin[]")]
pub fn builtin_devices() -> Vec<JsValue> {
    let record = |kind: &DeviceKind| {
        Record::new()
            .with("name", kind.name)
            .with("title", kind.title)
            .done()
    };
    od_devices::DEVICES.iter().map(record).collect()
}

pub(crate) fn valid(node_id: u8) -> Result<NodeId, JsError> {
    NodeId::new(node_id).ok_or_else(|| JsError::new("a node ID is 1 to 127"))
}
