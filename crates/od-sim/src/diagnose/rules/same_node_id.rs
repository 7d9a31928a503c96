//! Two nodes with one node ID.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, Node, Outcome, Seen, after, before, interleaved};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;
use crate::diagnose::rules::unasked_responses;

pub(super) const RULE: Rule = Rule {
    name: "same-node-id",
    title: "Two nodes with one node ID",
    needs_times: false,
    check,
};

/// The second response follows within this time, in microseconds; a late response after a time-out
/// does not.
const SOON: u64 = 50_000;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let mut all = Vec::from([
            ("a request has two responses", twice(facts, node)),
            (
                "one reset brings two boot-up messages",
                boots(facts, *id, node),
            ),
            ("two heartbeats take turns", beats(facts, node)),
        ]);
        all.retain(|(_, signs)| signs.len() >= 2);
        let Some((why, _)) = all.first() else {
            continue;
        };
        let signs = || all.iter().flat_map(|(_, signs)| signs);
        let (Some(first), Some(last)) = (
            signs().min_by_key(|seen| seen.at),
            signs().max_by_key(|seen| seen.at),
        ) else {
            continue;
        };
        found.push(
            Incident::new(format!("node {id}: {why}"), first.at, last.at)
                .node(*id)
                .shows(all[0].1.iter().map(|seen| seen.place))
                .cause(Cause::new(
                    "same-node-id",
                    format!("two devices have node ID {id}"),
                    format!("take one device off the bus; node {id} still answers. Then give it another node ID"),
                )),
        );
    }
    found
}

/// A reset command explains a boot-up message this long after it, in microseconds.
const COMMAND: u64 = 3_000_000;

/// The second responses to a request, each with the first one; both are about the same object, which a segment does not name.
fn twice(facts: &Facts<'_>, node: &Node) -> Vec<Seen> {
    let mut signs = Vec::new();
    let head = |seen: &Seen| {
        let frame = facts.frame(seen.place)?;
        (frame.bytes()[0] >= 0x40).then(|| frame.bytes()[1..4].to_vec())
    };
    for exchange in &node.exchanges {
        let is_done = matches!(exchange.outcome, Outcome::Answered | Outcome::Refused(_));
        let first = head(&exchange.end);
        let second = exchange.extra.iter().find(|extra| {
            let is_soon = extra.at.micros_since(exchange.end.at) <= SOON;
            is_soon && first.is_some() && head(extra) == first
        });
        let is_flood = exchange.extra.len() >= unasked_responses::FLOOD;
        if let Some(second) = second.filter(|_| is_done && !is_flood) {
            signs.extend([exchange.end, *second]);
        }
    }
    signs
}

/// Boot-up messages beyond one for each reset, within a second.
fn boots(facts: &Facts<'_>, id: u8, node: &Node) -> Vec<Seen> {
    let mut signs = Vec::new();
    let mut from = facts.begin;
    for pair in node.boots.windows(2) {
        let [first, second] = [pair[0], pair[1]];
        let is_near = second.at.micros_since(first.at) < 1_000_000;
        // A device that restarts without a command sends nothing for some milliseconds.
        let is_silent = before(after(&node.sent, first.at), second.at).is_empty();
        let earliest = od_wire::Instant::from_micros(first.at.as_micros().saturating_sub(COMMAND));
        if is_near
            && is_silent
            && facts.commands_to(id, first.at, second.at).next().is_none()
            && facts.is_reset(id, earliest.max(from), first.at)
        {
            signs.extend([first, second]);
        }
        // This boot-up message answers the resets until now.
        from = first.at.plus_micros(1);
    }
    signs
}

/// Heartbeats of two senders: they alternate, or their states do.
fn beats(facts: &Facts<'_>, node: &Node) -> Vec<Seen> {
    let states: Vec<u8> = node
        .states
        .iter()
        .filter(|(_, state)| *state != 0)
        .map(|(_, state)| *state)
        .collect();
    let turns = states
        .windows(3)
        .filter(|three| three[0] == three[2] && three[0] & 0x7F != three[1] & 0x7F);
    let is_turning = states.len() >= 6 && turns.count() * 2 >= states.len();
    let is_guarded = node.guards.len() * 2 > node.beats.len();
    if is_guarded {
        Vec::new()
    } else if is_turning {
        node.beats.clone()
    } else if facts.has_times {
        interleaved(&node.beats).to_vec()
    } else {
        Vec::new()
    }
}
