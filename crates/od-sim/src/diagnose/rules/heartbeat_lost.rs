//! A node whose heartbeat stops.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, Node, Seen, after, before, median_interval, millis, until};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "heartbeat-lost",
    title: "A heartbeat stops",
    needs_times: true,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        if node.beats.len() < 4 || node.guards.len() * 2 > node.beats.len() {
            continue;
        }
        let gaps = gaps(facts, node).into_iter();
        found.extend(gaps.filter_map(|(last, next)| incident(facts, *id, node, last, next)));
    }
    found
}

/// The times without a heartbeat: the last heartbeat before and the first one after. Period and
/// threshold come from the heartbeats before, since the last write of 1017h.
fn gaps(facts: &Facts<'_>, node: &Node) -> Vec<(Seen, Option<Seen>)> {
    let beats = &node.beats;
    let mut all = Vec::new();
    let writes = node
        .writes
        .iter()
        .filter(|(_, address, _)| address.index == 0x1017);
    let writes: Vec<Seen> = writes.map(|(seen, ..)| *seen).collect();
    for number in 3..=beats.len() {
        let last = beats[number - 1];
        let next = beats.get(number).copied();
        let written = until(&writes, last.at).last();
        let since = written.map_or(0, |written| until(beats, written.at).len());
        let own = beats
            .get(since.max(number.saturating_sub(12))..number)
            .unwrap_or_default();
        // Heartbeats without a pause do not make the period shorter.
        let period = match median_interval(own) {
            0 => 0,
            period => period.max(node.period),
        };
        let end = next.map_or(facts.end, |next| next.at);
        let longest = (period * 5 / 2).max(period + 20_000);
        let is_late = period > 0 && end.micros_since(last.at) > longest;
        if is_late && !node.is_written(0x1017, last.at, end.max(last.at)) {
            all.push((last, next));
        }
    }
    all
}

fn incident(
    facts: &Facts<'_>,
    id: u8,
    node: &Node,
    last: Seen,
    next: Option<Seen>,
) -> Option<Incident> {
    let until = next.map_or(facts.end, |next| next.at);
    let period = node.period;
    // A reset explains a pause. A pause of all nodes means that the recorder stopped.
    let is_reset = facts.is_reset(id, last.at, until) && !after(&node.boots, last.at).is_empty();
    if is_reset || !facts.goes_on(id, last.at, until) {
        return None;
    }
    let others = facts.nodes.iter().filter(|(other, node)| {
        let silent = last.at.plus_micros(3 * node.period);
        **other != id
            && node.beats.len() >= 4
            && node.beats[0].at <= last.at
            // Otherwise its next heartbeat was not due yet.
            && silent < until
            && before(after(&node.beats, silent), until).is_empty()
    });
    let together: Vec<u8> = others.map(|(other, _)| *other).collect();
    let mut all: Vec<u8> = together.iter().copied().chain([id]).collect();
    all.sort_unstable();
    let all: Vec<String> = all.iter().map(u8::to_string).collect();
    let still = before(after(&node.sent, last.at.plus_micros(period)), until);
    let text = match next {
        Some(next) => format!(
            "node {id}: no heartbeat for {}, it came every {} before",
            millis(next.at.micros_since(last.at)),
            millis(period)
        ),
        None => format!(
            "node {id}: the heartbeat, every {} until then, stops",
            millis(period)
        ),
    };
    let power = Cause::new(
        "connection",
        format!("node {id} has no power, or its cable came loose"),
        format!("power and connector of node {id}"),
    );
    let segment = Cause::new(
        "segment",
        format!(
            "nodes {} fall silent together: their supply, or the cable between them and the others",
            all.join(", ")
        ),
        "what these nodes share: a fuse, a power supply, a connector",
    );
    let busy = Cause::new(
        "node-busy",
        format!(
            "node {id} is alive but sends no heartbeat: its firmware is busy, or 1017h changed"
        ),
        format!("1017h of node {id}, and what its firmware does at this time"),
    );
    let mut incident = Incident::new(text, last.at, until)
        .node(id)
        .recovered(next.is_some())
        .shows([last.place])
        .shows(next.map(|next| next.place))
        .shows(still.iter().take(2).map(|seen| seen.place));
    // Nodes that became silent together are one incident.
    incident.nodes.extend(&together);
    incident
        .causes
        .extend(match (together.is_empty(), still.is_empty()) {
            (_, false) => [busy, power].into_iter().take(2),
            (false, _) => [segment, power].into_iter().take(2),
            (true, true) => [power, busy].into_iter().take(2),
        });
    Some(incident)
}
