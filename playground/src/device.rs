//! Devices on the bus.

use od_runtime::NodeId;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Crosses, record};

record! {
    /// A built-in device.
    Builtin {
        name: &'static str,
        title: &'static str,
        /// The page's first module lacks it.
        whole: bool,
    }
}

#[wasm_bindgen]
impl Bus {
    /// Returns the number of devices on the bus.
    #[wasm_bindgen(js_name = deviceCount)]
    pub fn device_count(&self) -> usize {
        self.journal.rig.bus.devices().len()
    }
}

/// The built-in devices, for `Bus.addDevice`.
#[wasm_bindgen(js_name = builtinDevices, unchecked_return_type = "Builtin[]")]
pub fn builtin_devices() -> Vec<JsValue> {
    let builtin =
        |(name, title): (&'static str, &'static str), whole| Builtin { name, title, whole };
    let encoders = od_devices::encoders().map(|kind| builtin((kind.name, kind.title), false));
    let machines = od_devices::MACHINES.map(|one| builtin(one, true));
    encoders.chain(machines).map(Crosses::value).collect()
}

pub(crate) fn valid(node_id: u8) -> Result<NodeId, JsError> {
    NodeId::new(node_id).ok_or_else(|| JsError::new("a node ID is 1 to 127"))
}
