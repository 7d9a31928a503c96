//! The bus, and time on it.

use od_bench::rig::Rig;
use od_runtime::Instant;
use wasm_bindgen::prelude::*;

use crate::packed;

/// A CAN bus with CANopen devices on it, in virtual time.
#[wasm_bindgen]
#[derive(Default)]
pub struct Bus {
    pub(crate) rig: Rig,
}

#[wasm_bindgen]
impl Bus {
    /// A bus without devices; its time is `micros`, 0 if not given.
    #[wasm_bindgen(constructor)]
    pub fn new(micros: Option<f64>) -> Bus {
        let now = Instant::from_micros(micros.unwrap_or(0.0) as u64);
        Bus { rig: Rig::at(now) }
    }

    /// Sends a frame from outside at the present moment. Of a remote frame only the
    /// number of bytes counts.
    pub fn send(&mut self, id: u32, data: &[u8], extended: bool, remote: bool) {
        if let Some(frame) = packed::make(id, data, extended, remote) {
            self.rig.send(&frame);
        }
    }

    /// Lets `micros` pass, or less if `max_frames` are sent before; answers with what passed.
    pub fn advance(&mut self, micros: f64, max_frames: usize) -> f64 {
        let start = self.rig.bus.now();
        let end = start.plus_micros(micros.max(0.0) as u64);
        let full = self.rig.pending() + max_frames.max(1);
        self.rig.pass(end, full);
        self.rig.bus.now().micros_since(start) as f64
    }

    /// Virtual microseconds.
    pub fn now(&self) -> f64 {
        self.rig.bus.now().as_micros() as f64
    }

    /// Number of frames that wait to be drained.
    pub fn pending(&self) -> usize {
        self.rig.pending()
    }

    /// All frames since the last call, own and others', 24 bytes each.
    pub fn drain(&mut self) -> Vec<u8> {
        let seen = self.rig.drain();
        let mut batch = Vec::with_capacity(seen.len() * packed::LEN);
        for one in &seen {
            packed::push_seen(&mut batch, one);
        }
        batch
    }
}
