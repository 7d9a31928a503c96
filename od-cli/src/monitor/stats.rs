//! Figures of each COB-ID, and the load of the bus.

use std::collections::{BTreeMap, VecDeque};

use od_bench::wire::bits::{INTERMISSION, bits};
use od_bus::filter::{Filter, Seen};
use od_model::values;
use od_wire::{Frame, Instant};
use serde_json::{Value, json};

use crate::bus::words::Told;

/// Distances in time that rate and jitter are made of.
const GAPS: usize = 32;
/// The load is that of the last second, in microseconds.
const WINDOW: u64 = 1_000_000;

/// Frames so far.
#[derive(Default)]
pub(super) struct Stats {
    rows: BTreeMap<(bool, u32), Row>,
    /// Bits of the frames of the last second.
    recent: VecDeque<(Instant, u64)>,
    /// Frames.
    pub(super) count: usize,
}

struct Row {
    frame: Frame,
    at: Instant,
    count: usize,
    /// The last distances, in microseconds.
    gaps: VecDeque<u64>,
    words: String,
}

impl Row {
    /// The mean distance of frames, in ms.
    fn period(&self) -> Option<f64> {
        let sum: u64 = self.gaps.iter().sum();
        (!self.gaps.is_empty()).then(|| sum as f64 / self.gaps.len() as f64 / 1e3)
    }

    /// The longest minus the shortest distance, in ms.
    fn jitter(&self) -> Option<f64> {
        let (low, high) = (self.gaps.iter().min()?, self.gaps.iter().max()?);
        (self.gaps.len() > 1).then(|| (high - low) as f64 / 1e3)
    }
}

impl Stats {
    pub(super) fn add(&mut self, told: &Told) {
        self.count += 1;
        let bits = bits(&told.frame).len() as u64 + INTERMISSION;
        self.recent.push_back((told.at, bits));
        self.forget(told.at);
        let id = told.frame.id();
        let row = self
            .rows
            .entry((id.is_extended(), id.raw()))
            .or_insert_with(|| Row {
                frame: told.frame,
                at: told.at,
                count: 0,
                gaps: VecDeque::new(),
                words: String::new(),
            });
        if row.count > 0 {
            row.gaps.push_back(told.at.micros_since(row.at));
            if row.gaps.len() > GAPS {
                row.gaps.pop_front();
            }
        }
        row.count += 1;
        (row.frame, row.at) = (told.frame, told.at);
        row.words = told.words.to_string();
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

    /// The share of the last second in which the bus was busy, in percent.
    pub(super) fn load(&mut self, now: Instant, kbit: u16) -> f64 {
        self.forget(now);
        let bits: u64 = self.recent.iter().map(|(_, bits)| bits).sum();
        // Of the bits that fit into a second.
        bits as f64 / (f64::from(kbit.max(1)) * 1e3) * 100.0
    }

    /// A line for each COB-ID, under a head: frames per second, jitter in ms.
    pub(super) fn table(&self) -> Vec<String> {
        self.filtered(&Filter::default())
    }

    /// As [`table`](Self::table), of the COB-IDs whose last frame passes.
    pub(super) fn filtered(&self, filter: &Filter) -> Vec<String> {
        let mut lines = vec![format!(
            "{:>8} {:>7} {:>7} {:>7}  {:<16}  last frame",
            "COB-ID", "frames", "per s", "jitter", "data"
        )];
        let rows = self.rows.values().filter(|row| {
            filter.passes(&Seen {
                frame: &row.frame,
                sent: false,
                words: &row.words,
            })
        });
        lines.extend(rows.map(|row| {
            let number =
                |number: Option<f64>| number.map_or(String::from("-"), |n| format!("{n:.1}"));
            let rate = row
                .period()
                .filter(|period| *period > 0.0)
                .map(|period| 1e3 / period);
            format!(
                "{:>8} {:>7} {:>7} {:>7}  {:<16}  {}",
                row.frame.id().to_string(),
                row.count,
                number(rate),
                number(row.jitter()),
                values::hex(row.frame.data()).replace(' ', ""),
                row.words
            )
        }));
        lines
    }

    pub(super) fn json(&mut self, now: Instant, kbit: u16) -> Value {
        let load = self.load(now, kbit);
        let rows = self.rows.values().map(|row| {
            json!({
                "id": row.frame.id().to_string(),
                "frames": row.count,
                "period_ms": row.period(),
                "jitter_ms": row.jitter(),
                "data": values::hex(row.frame.data()),
                "text": row.words,
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
