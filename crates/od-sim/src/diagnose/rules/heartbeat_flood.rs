//! Heartbeats that follow each other without a pause.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, Seen};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "heartbeat-flood",
    title: "Heartbeats without a pause",
    needs_times: true,
    check,
};

/// The shortest period of 1017h, in microseconds.
const SHORTEST: u64 = 1000;
/// As many heartbeats in a row, each too early, are a flood. Two nodes with one node ID send two.
const FLOOD: usize = 5;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let gap = |a: &Seen, b: &Seen| b.at.micros_since(a.at);
        // A node with a period of 1 ms sends all its heartbeats like this.
        let has_pauses = node
            .beats
            .windows(2)
            .any(|pair| gap(&pair[0], &pair[1]) > SHORTEST * 20);
        let shortest = if has_pauses {
            SHORTEST * 2
        } else {
            SHORTEST * 9 / 10
        };
        let is_early = |a: &Seen, b: &Seen| gap(a, b) < shortest;
        let runs = node.beats.chunk_by(is_early);
        let runs: Vec<&[Seen]> = runs.filter(|run| run.len() >= FLOOD).collect();
        let (Some([first, ..]), Some([.., last])) = (runs.first(), runs.last()) else {
            continue;
        };
        let count: usize = runs.iter().map(|run| run.len()).sum();
        found.push(
            Incident::new(
                format!("node {id} sends {count} heartbeats without a pause"),
                first.at,
                last.at,
            )
            .node(*id)
            .recovered(node.beats.last().is_some_and(|beat| beat.place > last.place))
            .shows(runs.iter().flat_map(|run| run.iter().take(4)).map(|seen| seen.place))
            .cause(Cause::new(
                "heartbeat-flood",
                format!("the firmware of node {id} sends a heartbeat in each pass of its loop: 1017h counts milliseconds"),
                format!("the timer of the heartbeat in the firmware of node {id}, above all after a reset"),
            )),
        );
    }
    found
}
