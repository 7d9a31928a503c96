//! Adds devices and sends frames without the journal, for a page that needs none.

#[cfg(feature = "eds")]
use od_sim::VirtualDevice;
use od_sim::journal::frame;
use od_sim::words;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
#[cfg(feature = "eds")]
use crate::crossing::{Crosses, record};
use crate::device::valid;
#[cfg(feature = "eds")]
use crate::diagnostics::{Diagnostic, findings};
use crate::{packed, values};

#[cfg(feature = "eds")]
record! {
    /// Result of loading an EDS text.
    EdsResult {
        /// The number of the device, or null if it cannot run.
        device: Option<usize>,
        diagnostics: Vec<Diagnostic>,
    }
}

#[wasm_bindgen]
impl Bus {
    /// Puts a built-in device on the bus and switches it on; returns its number.
    /// `builtinDevices` lists the names. With a `place` it takes the place of the device
    /// with that number. The further channels of a redundant encoder get the last numbers.
    ///
    /// # Errors
    /// The device does not exist, or the node ID is not 1 to 127.
    #[wasm_bindgen(js_name = addDevice)]
    pub fn add_device(
        &mut self,
        name: &str,
        node_id: u8,
        place: Option<usize>,
    ) -> Result<usize, JsError> {
        let node_id = valid(node_id)?;
        let kind = od_devices::find(name)
            .ok_or_else(|| JsError::new(&format!("device `{name}` does not exist")))?;
        Ok(self.acting().put_kind(kind, node_id, place))
    }

    /// Puts the device of an EDS or DCF text on the bus and switches it on.
    /// Returns its number, or `null` and the errors of the text. A lenient bus
    /// runs the valid part of a text with errors.
    ///
    /// # Errors
    /// The node ID is not 1 to 127.
    #[cfg(feature = "eds")]
    #[wasm_bindgen(js_name = addEds, unchecked_return_type = "EdsResult")]
    pub fn add_eds(
        &mut self,
        text: &str,
        node_id: u8,
        lenient: Option<bool>,
        place: Option<usize>,
    ) -> Result<JsValue, JsError> {
        let options = od_sim::EdsOptions {
            node_id: Some(valid(node_id)?),
            lenient: lenient.unwrap_or_default(),
        };
        let (device, found) = VirtualDevice::read_eds(text, options);
        let device = device.map(|device| self.acting().put(device, place));
        let diagnostics = findings(&found, text);
        Ok(EdsResult {
            device,
            diagnostics,
        }
        .value())
    }

    /// Removes a device from the bus; the numbers of later devices decrease by one.
    #[wasm_bindgen(js_name = removeDevice)]
    pub fn remove_device(&mut self, device: usize) {
        self.acting().remove(device);
    }

    /// A name to show.
    pub fn title(&self, device: usize) -> String {
        self.device(device)
            .map(|device| device.title().into())
            .unwrap_or_default()
    }

    /// The active node ID.
    #[wasm_bindgen(js_name = nodeId)]
    pub fn node_id(&self, device: usize) -> u8 {
        self.device(device)
            .map_or(0, |device| device.node_id().raw())
    }

    /// Sends a frame at the present moment. A remote frame has no data: `data` gives its DLC by its length.
    pub fn send(&mut self, id: u32, data: &[u8], extended: bool, remote: bool) {
        if let Some(frame) = frame(id, data, extended, remote) {
            self.acting().send(&frame);
        }
    }

    /// One packed frame in plain words, with the names of the objects.
    pub fn describe(&self, frame: &[u8]) -> String {
        self.words(frame)
    }

    /// The objects in a packed PDO by the current mapping, three numbers each:
    /// `index * 256 + sub`, first bit, number of bits. Empty for other frames.
    pub fn layout(&self, frame: &[u8]) -> Vec<u32> {
        packed::frame(frame)
            .and_then(|frame| words::layout(self.journal.rig.bus.devices(), &frame))
            .unwrap_or_default()
            .into_iter()
            .flat_map(|(address, first, bits)| [packed::object(address), first, bits])
            .collect()
    }

    /// The object dictionary of a device, one row for each value.
    #[wasm_bindgen(unchecked_return_type = "ObjectRecord[]")]
    pub fn dictionary(&self, device: usize) -> Vec<JsValue> {
        let Some(device) = self.device(device) else {
            return Vec::new();
        };
        values::dictionary(device.dictionary(), device.node_id().raw())
    }
}
