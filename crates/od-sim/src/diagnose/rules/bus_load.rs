//! A bus at its limit.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, Seen, WINDOW};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "bus-load",
    title: "The bus is at its limit",
    needs_times: true,
    check,
};

/// Load above which frames with a high CAN-ID wait for many others.
const HIGH: f64 = 0.8;
/// This number of windows of 100 ms is an incident.
const WINDOWS: usize = 3;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let (Some(loads), Some(rate)) = (facts.loads(), facts.rate) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    for windows in loads.chunk_by(|a, b| (a.1 >= HIGH) == (b.1 >= HIGH)) {
        let [(begin, load), ..] = windows else {
            continue;
        };
        if *load < HIGH || windows.len() < WINDOWS {
            continue;
        }
        let end = begin.plus_micros(windows.len() as u64 * WINDOW);
        let mean = windows.iter().map(|(_, load)| load).sum::<f64>() / windows.len() as f64;
        let first = facts.frames.partition_point(|seen| seen.at < *begin);
        let last = facts.frames.partition_point(|seen| seen.at < end);
        let inside = &facts.frames[first..last];
        let (id, share, shown) = loudest(facts, inside);
        found.push(
            Incident::new(
                format!("the bus load is {:.0} % at {rate} kbit/s", mean * 100.0),
                *begin,
                end,
            )
            .recovered(end.plus_micros(WINDOW) < facts.end)
            .shows(shown)
            .cause(Cause::new(
                "bus-load",
                format!("{id:03X}h has {share} % of the frames"),
                format!("event timer and inhibit time of the PDO with CAN-ID {id:03X}h; or use a higher bit rate"),
            )),
        );
    }
    found
}

/// The CAN-ID with the most frames, its share in percent, and the first of them.
fn loudest(facts: &Facts<'_>, inside: &[Seen]) -> (u32, usize, Vec<usize>) {
    let mut counts = std::collections::BTreeMap::new();
    for seen in inside {
        if let Some(frame) = facts.frame(seen.place) {
            let places: &mut Vec<usize> = counts.entry(frame.id().raw()).or_default();
            places.push(seen.place);
        }
    }
    let most = counts.into_iter().max_by_key(|(_, places)| places.len());
    let (id, places) = most.unwrap_or_default();
    let share = places.len() * 100 / inside.len().max(1);
    (id, share, places.into_iter().take(4).collect())
}
