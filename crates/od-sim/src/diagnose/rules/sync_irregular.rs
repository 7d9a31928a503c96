//! SYNC that does not keep its period.

use std::format;
use std::prelude::v1::*;

use od_wire::Instant;

use crate::diagnose::facts::{Facts, Seen, from, interleaved, median_interval, millis, until};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "sync-irregular",
    title: "SYNC does not keep its period",
    needs_times: true,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let all = &facts.syncs;
    let period = median_interval(all);
    if all.len() < 20 || period == 0 || !interleaved(all).is_empty() {
        return Vec::new();
    }
    let gap = |pair: &[Seen]| pair[1].at.micros_since(pair[0].at);
    let near = all
        .windows(2)
        .filter(|pair| gap(pair).abs_diff(period) * 2 <= period);
    let near: Vec<&[Seen]> = near.collect();
    // SYNC messages that were not meant to be periodic.
    if near.len() * 10 < (all.len() - 1) * 8 {
        return Vec::new();
    }
    let mut found = Vec::new();
    let off: Vec<&&[Seen]> = near
        .iter()
        .filter(|pair| gap(pair).abs_diff(period) * 10 > period)
        .collect();
    if off.len() * 20 >= near.len() {
        let most = off
            .iter()
            .map(|pair| gap(pair).abs_diff(period))
            .max()
            .unwrap_or(0);
        let (first, last) = (off[0][0], off[off.len() - 1][1]);
        found.push(
            Incident::new(
                format!("SYNC every {} is off by up to {}", millis(period), millis(most)),
                first.at,
                last.at,
            )
            .shows(off.iter().take(3).flat_map(|pair| pair.iter().map(|seen| seen.place)))
            .cause(Cause::new(
                "sync-jitter",
                "the producer sends SYNC from a task that is not punctual",
                "priority and timer of the producer's task; a controller that sends SYNC by hardware timer is exact",
            ))
            .cause(Cause::new(
                "bus-load",
                "frames of lower CAN-IDs, or long frames, delay SYNC",
                "the bus load around the frames below",
            )),
        );
    }
    let lost: Vec<&[Seen]> = all
        .windows(2)
        .filter(|pair| gap(pair) * 10 >= period * 18 && !is_meant(facts, pair, period))
        .collect();
    if let [first, ..] = lost[..] {
        let last = lost[lost.len() - 1];
        found.push(
            Incident::new(
                format!(
                    "SYNC every {} is missing {} times",
                    millis(period),
                    lost.len()
                ),
                first[0].at,
                last[1].at,
            )
            .recovered(true)
            .shows(
                lost.iter()
                    .take(3)
                    .flat_map(|pair| pair.iter().map(|seen| seen.place)),
            )
            .cause(Cause::new(
                "sync-lost",
                "the producer of SYNC paused",
                "the producer: its task, its restarts, its NMT state",
            )),
        );
    }
    found
}

/// Returns whether a command or a write explains a pause: NMT (CiA 301, 7.3.2.2: no SYNC in Stopped), 1005h or 1006h.
fn is_meant(facts: &Facts<'_>, pause: &[Seen], period: u64) -> bool {
    let [start, end] = [pause[0].at, pause[1].at];
    let start = Instant::from_micros(start.as_micros().saturating_sub(period));
    let commands = until(from(&facts.commands, start), end);
    let mut nodes = facts.nodes.values();
    !commands.is_empty()
        || nodes.any(|node| {
            [0x1005, 0x1006].map(|index| node.is_written(index, start, end)) != [false; 2]
        })
}
