//! Figures for each COB-ID, and the bus load.

use std::collections::{BTreeMap, VecDeque};

use od_model::values;
use od_sim::line::bits::occupied;
use od_sim::stats::{Ids, Row};
use od_tools::filter::{Filter, FilteredFrame};
use od_wire::{CanId, Instant};
use serde_json::{Value, json};

use crate::bus::words::ExplainedFrame;

/// Interval of the load, in microseconds.
const WINDOW: u64 = 1_000_000;

/// Number of frames.
#[derive(Default)]
pub(super) struct Stats {
    ids: Ids,
    /// The words of the last frame of each COB-ID.
    words: BTreeMap<(bool, u32), String>,
    /// Bits of the frames of the last second.
    recent: VecDeque<(Instant, u64)>,
    /// Frames.
    pub(super) count: usize,
}

const fn key(id: CanId) -> (bool, u32) {
    (id.is_extended(), id.raw())
}

/// Jitter in ms.
fn jitter(row: &Row) -> Option<f64> {
    row.jitter().map(|micros| micros as f64 / 1e3)
}

/// The mean period of the last frames, in ms.
fn period(row: &Row) -> Option<f64> {
    row.recent_period().map(|micros| micros / 1e3)
}

impl Stats {
    pub(super) fn add(&mut self, told: &ExplainedFrame) {
        self.count += 1;
        let bits = occupied(&told.frame);
        self.recent.push_back((told.at, bits));
        self.forget(told.at);
        self.ids.take(told.at, &told.frame);
        self.words
            .insert(key(told.frame.id()), told.words.to_string());
    }

    /// The text of the last frame of a row.
    fn words(&self, row: &Row) -> &str {
        self.words
            .get(&key(row.frame.id()))
            .map_or("", String::as_str)
    }

    fn forget(&mut self, now: Instant) {
        while self
            .recent
            .front()
            .is_some_and(|(at, _)| now.micros_since(*at) > WINDOW)
        {
            self.recent.pop_front();
        }
    }

    /// Percentage of the last second in which the bus was busy.
    pub(super) fn load(&mut self, now: Instant, kbit: u16) -> f64 {
        self.forget(now);
        let bits: u64 = self.recent.iter().map(|(_, bits)| bits).sum();
        // Relative to the bits of a second.
        bits as f64 / (f64::from(kbit.max(1)) * 1e3) * 100.0
    }

    /// A line for each COB-ID below a heading: frames per second, jitter in ms.
    pub(super) fn table(&self) -> Vec<String> {
        self.filtered(&Filter::default())
    }

    /// Like [`table`](Self::table), for the COB-IDs whose last frame passes the filter.
    pub(super) fn filtered(&self, filter: &Filter) -> Vec<String> {
        let mut lines = vec![format!(
            "{:>8} {:>7} {:>7} {:>7}  {:<16}  last frame",
            "COB-ID", "frames", "per s", "jitter", "data"
        )];
        let rows = self.ids.rows().iter().filter(|row| {
            filter.passes(&FilteredFrame {
                frame: &row.frame,
                sent: false,
                words: self.words(row),
            })
        });
        lines.extend(rows.map(|row| {
            let number =
                |number: Option<f64>| number.map_or(String::from("-"), |n| format!("{n:.1}"));
            let rate = period(row)
                .filter(|period| *period > 0.0)
                .map(|period| 1e3 / period);
            format!(
                "{:>8} {:>7} {:>7} {:>7}  {:<16}  {}",
                row.frame.id().to_string(),
                row.count,
                number(rate),
                number(jitter(row)),
                values::hex(row.frame.data()).replace(' ', ""),
                self.words(row)
            )
        }));
        lines
    }

    pub(super) fn json(&mut self, now: Instant, kbit: u16) -> Value {
        let load = self.load(now, kbit);
        let rows = self.ids.rows().iter().map(|row| {
            json!({
                "id": row.frame.id().to_string(),
                "frames": row.count,
                "period_ms": period(row),
                "jitter_ms": jitter(row),
                "data": values::hex(row.frame.data()),
                "text": self.words(row),
            })
        });
        json!({
            "frames": self.count,
            "load_percent": load,
            "ids": rows.collect::<Vec<_>>(),
        })
    }
}

#[cfg(test)]
mod tests {
    use od_wire::Frame;

    use super::*;
    use crate::bus::names::Names;
    use crate::bus::words::Narrator;

    #[test]
    fn rate_jitter_and_load_are_those_of_the_frames() {
        let names = Names::read(&[]).ok().expect("no file");
        let mut narrator = Narrator::new(names, "").ok().expect("no filter");
        let mut stats = Stats::default();
        let frame = Frame::standard(0x185, &[0x55; 8]);
        // Every 10 ms, one of them 2 ms late.
        for at in [0, 10, 20, 32, 40_u64] {
            let told = narrator.tell(Instant::from_millis(at), frame, false);
            stats.add(&told.expect("no filter"));
        }
        let report = stats.json(Instant::from_millis(40), 500);
        let row = &report["ids"][0];
        assert_eq!(
            (&row["frames"], &row["period_ms"]),
            (&json!(5), &json!(10.0))
        );
        assert_eq!(row["jitter_ms"], json!(4.0));
        let load = report["load_percent"].as_f64().expect("a number");
        // Five frames of 111 bits and some stuff bits, of 500,000.
        assert!((0.111..0.14).contains(&load), "{load}");
        assert_eq!(stats.load(Instant::from_millis(1041), 500), 0.0);
        assert_eq!(stats.table().len(), 2);
        let none = Filter::parse("node:6").expect("a filter");
        assert_eq!(stats.filtered(&none).len(), 1);
    }
}
