//! Figures of captured frames.

use od_runtime::Instant;
use od_sim::stats::{Clients, Ids, Times};
use wasm_bindgen::prelude::*;

use crate::packed;

/// Figures of each CAN-ID and of each SDO client, from the frames that were added. Times are in microseconds.
#[wasm_bindgen]
#[derive(Default)]
pub struct Statistics {
    ids: Ids,
    clients: Clients,
}

#[wasm_bindgen]
impl Statistics {
    /// No frame was counted so far.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the next packed frames; disturbed ones are ignored.
    pub fn take(&mut self, frames: &[u8]) {
        for one in frames.chunks_exact(packed::LEN) {
            let frame = packed::frame(one).filter(|_| !packed::is_disturbed(one));
            if let (Some(frame), Some(micros)) = (frame, packed::micros(one)) {
                let at = Instant::from_micros(micros as u64);
                self.ids.take(at, &frame);
                self.clients.take(at, &frame);
            }
        }
    }

    /// Eight numbers for each CAN-ID, those of 11 bits first: CAN-ID (plus 2³² if it has 29 bits), frames; the last
    /// period, the shortest, mean and longest; jitter; time of the last change of its data. NaN: not known.
    pub fn ids(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for row in self.ids.rows() {
            let id = row.frame.id();
            let extended = if id.is_extended() {
                4_294_967_296.0
            } else {
                0.0
            };
            all.extend_from_slice(&[
                f64::from(id.raw()) + extended,
                f64::from(row.count),
                number(row.cycle()),
            ]);
            all.extend_from_slice(&times(row.period()));
            let changed = row.changed.map(Instant::as_micros);
            all.extend_from_slice(&[number(row.jitter()), number(changed)]);
        }
        all
    }

    /// Seven numbers for each SDO client: node ID of its server, requests; shortest, mean and longest response time;
    /// aborts; requests without a response. NaN: not known.
    pub fn clients(&self) -> Vec<f64> {
        let mut all = Vec::new();
        for client in self.clients.all() {
            all.extend_from_slice(&[client.node.into(), client.requests.into()]);
            all.extend_from_slice(&times(client.times()));
            all.extend_from_slice(&[f64::from(client.aborts), client.unanswered.into()]);
        }
        all
    }

    /// Removes everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

fn number(micros: Option<u64>) -> f64 {
    micros.map_or(f64::NAN, |micros| micros as f64)
}

fn times(times: Option<Times>) -> [f64; 3] {
    times.map_or([f64::NAN; 3], |one| {
        [one.least as f64, one.mean, one.most as f64]
    })
}
