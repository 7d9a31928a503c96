//! Figures of captured frames.

use od_bench::stats::{Clients, Ids, Times};
use od_runtime::Instant;
use wasm_bindgen::prelude::*;

use crate::packed;

/// Figures of each CAN-ID and of each SDO client, from the frames that it took. Times are in microseconds.
#[wasm_bindgen]
#[derive(Default)]
pub struct Statistics {
    ids: Ids,
    clients: Clients,
}

#[wasm_bindgen]
impl Statistics {
    /// No frame was taken so far.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the next packed frames; one that was disturbed does not count.
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
    /// period, the shortest, mean and longest; jitter; moment of the last change of its data. NaN: there is none.
    pub fn ids(&self) -> Vec<f64> {
        let rows = self.ids.rows().flat_map(|row| {
            let id = row.frame.id();
            let key = f64::from(id.raw()) + f64::from(u8::from(id.is_extended())) * 4_294_967_296.0;
            let number = |micros: Option<u64>| micros.map_or(f64::NAN, |micros| micros as f64);
            let changed = number(row.changed.map(Instant::as_micros));
            let (cycle, jitter) = (number(row.cycle()), number(row.jitter()));
            let [least, mean, most] = times(row.period());
            let count = f64::from(row.count);
            [key, count, cycle, least, mean, most, jitter, changed]
        });
        rows.collect()
    }

    /// Seven numbers for each SDO client: node ID of its server, requests; shortest, mean and longest time to answer;
    /// aborts; requests without an answer. NaN: there is none.
    pub fn clients(&self) -> Vec<f64> {
        let rows = self.clients.all().flat_map(|(node, client)| {
            let [least, mean, most] = times(client.times());
            let (aborts, unanswered) = (client.aborts.into(), client.unanswered.into());
            let requests = client.requests.into();
            [node.into(), requests, least, mean, most, aborts, unanswered]
        });
        rows.collect()
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

fn times(times: Option<Times>) -> [f64; 3] {
    times.map_or([f64::NAN; 3], |one| {
        [one.least as f64, one.mean, one.most as f64]
    })
}
