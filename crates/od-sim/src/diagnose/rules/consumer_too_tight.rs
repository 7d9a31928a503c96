//! A heartbeat consumer that reports an error although heartbeats arrive.

use std::format;
use std::prelude::v1::*;

use od_model::Address;

use crate::diagnose::facts::{Facts, Seen, before, median_interval, millis, until};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "consumer-too-tight",
    title: "A heartbeat consumer is too tight",
    needs_times: true,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let own: Vec<_> = node
            .emcys
            .iter()
            .filter(|emcy| emcy.code == 0x8130)
            .collect();
        let [first, ..] = own[..] else {
            continue;
        };
        // A guarded node reports the loss of its master.
        if before(&node.guards, first.seen.at).len() >= 3 {
            continue;
        }
        let last = own[own.len() - 1];
        let ended = node
            .emcys
            .iter()
            .rev()
            .find(|emcy| emcy.code == 0 && emcy.seen.at >= last.seen.at);
        let mut incident = Incident::new(
            format!("node {id} reports a heartbeat error (EMCY 8130h)"),
            first.seen.at,
            ended.map_or(last.seen.at, |ended| ended.seen.at),
        )
        .node(*id)
        .recovered(ended.is_some())
        .shows(own.iter().map(|emcy| emcy.seen.place));
        let watched = watched(facts, *id, first.seen);
        let Some((other, time)) = watched else {
            found.push(incident.cause(Cause::new(
                "heartbeat-missing",
                format!("a node that node {id} monitors sends no heartbeat in time"),
                format!("1016h of node {id}: which node, and what time"),
            )));
            continue;
        };
        let other_node = facts.nodes.get(&other);
        let beats = other_node.map_or(&[][..], |node| &node.beats);
        let earlier = until(beats, first.seen.at);
        let period = other_node.map_or(0, |node| node.period);
        let silent = earlier
            .last()
            .map(|last| first.seen.at.micros_since(last.at));
        incident = incident.shows(earlier.iter().rev().take(2).map(|seen| seen.place));
        let time = u64::from(time) * 1000;
        if period > 0
            && (time < period * 3 / 2 || silent.is_some_and(|silent| silent < period * 3 / 2))
        {
            incident = incident.cause(Cause::new(
                "consumer-too-tight",
                format!(
                    "node {id} allows node {other} {}, and its heartbeat comes every {}",
                    millis(time),
                    millis(period)
                ),
                format!("1016h of node {id}: at least 1.5 times, better twice, the time in 1017h of node {other}"),
            ));
        } else {
            // Here the loss of the heartbeat is the fault, and this is its sign.
            incident.nodes.push(other);
            incident = incident.cause(Cause::new(
                "heartbeat-missing",
                format!("node {other}, which node {id} monitors, sends no heartbeat"),
                format!("1017h of node {other}, its power and its connector"),
            ));
        }
        found.push(incident);
    }
    found
}

/// The node that a consumer misses, and its time in milliseconds: the entry of 1016h whose
/// heartbeat has been missing longest.
fn watched(facts: &Facts<'_>, id: u8, emcy: Seen) -> Option<(u8, u32)> {
    let entries = (1..=127).filter_map(|sub| facts.value(id, Address::new(0x1016, sub), emcy.at));
    let entries = entries.filter(|raw| raw & 0xFFFF != 0 && raw >> 16 & 0x7F != 0);
    let entries = entries.map(|raw| ((raw >> 16 & 0x7F) as u8, raw & 0xFFFF));
    let silent = |node: u8| {
        let last = until(&facts.nodes.get(&node)?.beats, emcy.at).last()?;
        Some(emcy.at.micros_since(last.at))
    };
    let known = entries.max_by_key(|(node, time)| {
        silent(*node).map(|micros| micros as i64 - i64::from(*time) * 1000)
    });
    known.or_else(|| missing(facts, id, emcy))
}

/// The only node whose heartbeat is missing when another node reports it, and the time since the last one.
fn missing(facts: &Facts<'_>, id: u8, emcy: Seen) -> Option<(u8, u32)> {
    let others = facts.nodes.iter().filter(|(other, _)| **other != id);
    let mut silent = others.filter_map(|(other, node)| {
        let beats = until(&node.beats, emcy.at);
        let since = emcy.at.micros_since(beats.last()?.at);
        let is_late = beats.len() >= 3 && since > median_interval(beats) * 3 / 2;
        is_late.then_some((*other, u32::try_from(since / 1000).ok()?))
    });
    silent.next().filter(|_| silent.next().is_none())
}
