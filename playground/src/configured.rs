//! A configured device as a file.

use od_sim::journal::Source;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;

#[wasm_bindgen]
impl Bus {
    /// A DCF (CiA 306-1) of a device, with its node ID, its bit rate and every
    /// value that differs from the factory value. `name` is a built-in device, `text` an EDS or
    /// DCF text; without both, the journal has the device.
    ///
    /// # Errors
    /// The device does not exist.
    #[wasm_bindgen(js_name = exportDcf)]
    pub fn export_dcf(
        &mut self,
        device: usize,
        name: Option<String>,
        text: Option<String>,
    ) -> Result<String, JsError> {
        let placed = self.journal.devices().get(device);
        let (name, text) = match placed.map(|placed| &placed.source) {
            Some(Source::Builtin { name }) if text.is_none() => (Some(name.clone()), None),
            Some(Source::Eds { text, .. }) if name.is_none() => (None, Some(text.clone())),
            _ => (name, text),
        };
        let text = match (name, text) {
            (_, Some(text)) => text,
            (Some(name), None) => {
                let kind = od_devices::find(&name)
                    .ok_or_else(|| JsError::new(&format!("device `{name}` does not exist")))?;
                od_devices::text::eds(kind)
            }
            (None, None) => return Err(JsError::new("say which device it is, or its text")),
        };
        let mut description = od_eds::load(&text).description;
        self.journal
            .rig
            .with(device, |device, _| {
                device.write_configuration(&mut description)
            })
            .ok_or_else(|| JsError::new("no device has this number"))?;
        Ok(od_eds::write(&description))
    }
}
