//! The bus, and its time.

use od_runtime::Instant;
use od_sim::VirtualDevice;
use od_sim::journal::Journal;
use od_sim::rig::Rig;
use wasm_bindgen::prelude::*;

use crate::packed;

/// A CAN bus with CANopen devices on it, in virtual time.
#[wasm_bindgen]
pub struct Bus {
    pub(crate) journal: Journal,
}

#[wasm_bindgen]
impl Bus {
    /// A bus without devices; its time is `micros`, 0 if not given.
    #[wasm_bindgen(constructor)]
    pub fn new(micros: Option<f64>) -> Bus {
        let mut journal = Journal::new(od_devices::DEVICES);
        journal.rig = Rig::at(Instant::from_micros(micros.unwrap_or(0.0) as u64));
        Bus { journal }
    }

    /// Returns whether a frame of the program waits for the line or is being transmitted.
    #[wasm_bindgen(js_name = isSending)]
    pub fn is_sending(&self) -> bool {
        self.journal.rig.bus.is_sending(0)
    }

    /// Lets `micros` pass, or less if `max_frames` are sent before; returns the time that passed.
    /// Repeats the inputs of the journal for that time.
    pub fn advance(&mut self, micros: f64, max_frames: usize) -> f64 {
        let micros = micros.max(0.0) as u64;
        self.journal.advance(micros, max_frames.max(1)) as f64
    }

    /// Virtual time in microseconds.
    pub fn now(&self) -> f64 {
        self.journal.rig.bus.now().as_micros() as f64
    }

    /// Number of frames that were not drained yet.
    pub fn pending(&self) -> usize {
        self.journal.rig.pending()
    }

    /// All frames since the last call, of devices and of this side, 24 bytes each.
    pub fn drain(&mut self) -> Vec<u8> {
        let rig = &mut self.journal.rig;
        let mut batch = Vec::with_capacity(rig.pending() * packed::LEN);
        rig.drain_to(|one| packed::push_event(&mut batch, one));
        batch
    }
}

impl Bus {
    pub(crate) fn device(&self, device: usize) -> Option<&VirtualDevice> {
        self.journal.rig.bus.devices().get(device)
    }
}
