//! A node that restarts without a command.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, Node, Seen, after, before, millis, until};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "reboots",
    title: "A node restarts without a command",
    needs_times: false,
    check,
};

/// A reset command explains a boot-up message this long after it, in microseconds.
const BOOT: u64 = 10_000_000;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let nodes = facts.nodes.iter();
    nodes
        .filter_map(|(id, node)| incident(facts, *id, node))
        .collect()
}

fn incident(facts: &Facts<'_>, id: u8, node: &Node) -> Option<Incident> {
    let own: Vec<Seen> = node
        .boots
        .iter()
        .copied()
        .filter(|boot| is_own(facts, id, node, *boot))
        .collect();
    let (first, last) = (*own.first()?, *own.last()?);
    let alive = before(&node.sent, first.at).last();
    let begin = alive.map_or(first.at, |seen| seen.at);
    let lived = !after(&node.sent, last.at).is_empty();
    let text = match own.len() {
        1 => format!("node {id} restarts without a command"),
        count => format!("node {id} restarts {count} times without a command"),
    };
    let mut incident = Incident::new(text, begin, last.at)
        .node(id)
        .recovered(lived)
        .shows(
            alive
                .map(|seen| seen.place)
                .into_iter()
                .chain(own.iter().map(|seen| seen.place)),
        );
    let voltage = node.emcys.iter().find(|emcy| {
        matches!(emcy.code >> 12, 3)
            && emcy.seen.at.plus_micros(2_000_000) >= first.at
            && emcy.seen.at <= last.at
    });
    let supply = Cause::new(
        "supply",
        format!("the supply of node {id} drops, or its connector has a bad contact"),
        format!("the voltage at node {id} under load, and its connector"),
    );
    let watchdog = |why: &str| {
        Cause::new(
            "watchdog",
            format!("the firmware of node {id} fails, and its watchdog restarts it{why}"),
            format!(
                "what node {id} does right before: the frames below, its EMCY history (1003h), its log"
            ),
        )
    };
    let trigger = trigger(facts, &own, id);
    let gaps: Vec<u64> = own
        .windows(2)
        .map(|pair| pair[1].at.micros_since(pair[0].at))
        .collect();
    let mean = gaps.iter().sum::<u64>() / (gaps.len().max(1) as u64);
    let is_regular = facts.has_times
        && gaps.len() >= 2
        && gaps.iter().all(|gap| gap.abs_diff(mean) * 10 <= mean);
    if let Some(emcy) = voltage {
        incident = incident
            .shows([emcy.seen.place])
            .cause(supply)
            .cause(watchdog(""));
    } else if let Some(frame) = trigger {
        let why = format!(", each time after {frame}");
        incident = incident.cause(watchdog(&why)).cause(supply);
    } else if is_regular {
        let why = format!(", every {}", millis(mean));
        incident = incident.cause(watchdog(&why)).cause(supply);
    } else {
        incident = incident.cause(supply).cause(watchdog(""));
    }
    Some(incident)
}

/// Returns whether a boot-up message has no command as its reason: the node was active before, and
/// no reset was sent.
fn is_own(facts: &Facts<'_>, id: u8, node: &Node, boot: Seen) -> bool {
    if before(&node.sent, boot.at).is_empty() {
        return false;
    }
    let earliest = boot.at.as_micros().saturating_sub(BOOT);
    let since = before(&node.boots, boot.at).last();
    let from = since.map_or(facts.begin, |other| other.at);
    let from = from.max(od_wire::Instant::from_micros(earliest));
    // LSS gives a node its node ID, and a boot-up message follows.
    let lss = until(&facts.lss, boot.at).last();
    let by_lss = lss.is_some_and(|seen| boot.at.micros_since(seen.at) < BOOT);
    !facts.is_reset(id, from, boot.at) && !by_lss
}

/// The frame to the node just before each restart, if there is one.
fn trigger(facts: &Facts<'_>, own: &[Seen], id: u8) -> Option<String> {
    if own.len() < 3 || !facts.has_times {
        return None;
    }
    let requests = &facts.nodes.get(&id)?.exchanges;
    let before = own.iter().map(|boot| {
        let last = until(requests, boot.at).last()?;
        (boot.at.micros_since(last.request.at) < 1_000_000).then_some(last.address)?
    });
    let mut all = before.collect::<Option<Vec<_>>>()?;
    all.dedup();
    match all[..] {
        [address] => Some(format!("an SDO request about {address}")),
        _ => None,
    }
}
