//! SDO responses that nobody requested.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Exchange, Facts};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "unasked-responses",
    title: "A node sends SDO responses that nobody requested",
    needs_times: false,
    check,
};

/// A request with as many further responses is a flood. A second node, or a late response, is one further response.
pub(super) const FLOOD: usize = 3;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let is_flood = |one: &&Exchange| one.extra.len() >= FLOOD;
        let floods: Vec<&Exchange> = node.exchanges.iter().filter(is_flood).collect();
        let (Some(first), Some(last)) = (floods.first(), floods.last()) else {
            continue;
        };
        let extra = || floods.iter().flat_map(|one| &one.extra);
        let end = extra().last().map_or(last.end.at, |seen| seen.at);
        found.push(
            Incident::new(
                format!("node {id}: {} SDO responses that nobody requested", extra().count()),
                first.request.at,
                end,
            )
            .node(*id)
            .recovered(last.request.place < node.exchanges.last().map_or(0, |one| one.request.place))
            .shows([first.request.place, first.end.place])
            .shows(extra().take(4).map(|seen| seen.place))
            .cause(Cause::new(
                "firmware-repeats",
                format!("the firmware of node {id} sends a response more than once, or what is in its buffer"),
                format!("the CAN driver of node {id}: its transmit buffers and their interrupt; whether a second program writes into them"),
            )),
        );
    }
    found
}
