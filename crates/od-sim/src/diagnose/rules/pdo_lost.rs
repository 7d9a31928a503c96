//! A cyclic PDO with gaps.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, Seen, from, median_interval, millis, until};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "pdo-lost",
    title: "A cyclic PDO has gaps",
    needs_times: true,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, seen) in &facts.pdos {
        // A write to a parameter may change the period.
        let node = facts.nodes.get(&((id & 0x7F) as u8));
        let writes = node.map_or(&[][..], |node| &node.writes).iter();
        let writes = writes.filter(|(_, address, _)| matches!(address.index, 0x1800..=0x1BFF));
        let writes: Vec<_> = writes.map(|(seen, ..)| seen.at).collect();
        let part = |seen: &Seen| writes.partition_point(|at| *at <= seen.at);
        let parts = seen.chunk_by(|a, b| part(a) == part(b));
        found.extend(parts.filter_map(|part| incident(facts, *id, part)));
    }
    found
}

fn incident(facts: &Facts<'_>, id: u16, seen: &[Seen]) -> Option<Incident> {
    let period = median_interval(seen);
    if seen.len() < 12 || period == 0 {
        return None;
    }
    let gap = |pair: &[Seen]| pair[1].at.micros_since(pair[0].at);
    let steady = seen
        .windows(2)
        .filter(|pair| gap(pair).abs_diff(period) * 10 <= period * 2)
        .count();
    // An event-driven PDO has no period.
    if steady * 10 < (seen.len() - 1) * 7 {
        return None;
    }
    let node = (id & 0x7F) as u8;
    let gaps: Vec<&[Seen]> = seen
        .windows(2)
        .filter(|pair| gap(pair) * 10 >= period * 18)
        // An NMT command, a reset or a changed parameter explains a pause.
        .filter(|pair| {
            let (start, end) = (pair[0].at.as_micros().saturating_sub(period), pair[1].at);
            let start = od_wire::Instant::from_micros(start);
            let is_written = facts.nodes.get(&node).is_some_and(|node| {
                let mut writes = from(until(&node.writes, end), start).iter();
                let is_its = |index| matches!(index, 0x1005 | 0x1006 | 0x1800..=0x1BFF);
                writes.any(|(_, address, _)| is_its(address.index))
            });
            facts.commands_to(node, start, end).next().is_none() && !is_written
        })
        .collect();
    let first = *gaps.first()?;
    let last = gaps[gaps.len() - 1];
    let with_sync = synchronous(facts, seen);
    let lost_syncs = with_sync
        && gaps
            .iter()
            .all(|pair| syncs_in(facts, pair[0], pair[1]) == 0);
    let mut incident = Incident::new(
        format!(
            "{id:03X}h, every {}, is missing {} times",
            millis(period),
            gaps.len()
        ),
        first[0].at,
        last[1].at,
    )
    .node(node)
    .recovered(true)
    .shows(
        gaps.iter()
            .take(3)
            .flat_map(|pair| pair.iter().map(|seen| seen.place)),
    );
    let load = Cause::new(
        "bus-load",
        "frames with lower CAN-IDs take the bus",
        "the bus load at these times, and the number of transmit buffers of the node",
    );
    let sender = Cause::new(
        "sender",
        format!("the node that sends {id:03X}h leaves it out"),
        "its inhibit time, its task, and its NMT state",
    );
    let sync = Cause::new("sync-lost", "SYNC was missing, too", "the producer of SYNC");
    let is_loaded = is_loaded(facts, first[0], first[1]);
    incident.causes.extend(match (lost_syncs, is_loaded) {
        (true, _) => [sync, sender],
        (false, true) => [load, sender],
        (false, false) => [sender, load],
    });
    Some(incident)
}

/// Returns whether at least 90 % of these frames come within 10 ms after a SYNC.
fn synchronous(facts: &Facts<'_>, seen: &[Seen]) -> bool {
    let follows = seen.iter().filter(|seen| {
        let before = facts.syncs.partition_point(|sync| sync.place < seen.place);
        before > 0 && seen.at.micros_since(facts.syncs[before - 1].at) < 10_000
    });
    !facts.syncs.is_empty() && follows.count() * 10 >= seen.len() * 9
}

/// Number of SYNCs between two PDOs for which a PDO is missing.
fn syncs_in(facts: &Facts<'_>, from: Seen, to: Seen) -> usize {
    let count = |place: usize| facts.syncs.partition_point(|sync| sync.place < place);
    // The last of these SYNCs belongs to the second PDO.
    count(to.place).saturating_sub(count(from.place) + 1)
}

fn is_loaded(facts: &Facts<'_>, from: Seen, to: Seen) -> bool {
    let loads = facts.loads().unwrap_or_default();
    loads
        .iter()
        .any(|(at, load)| *at >= from.at && *at <= to.at && *load > 0.7)
}
