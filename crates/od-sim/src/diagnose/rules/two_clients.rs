//! Two clients on one SDO channel.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Exchange, Facts, Outcome};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "two-clients",
    title: "Two clients on one SDO channel",
    needs_times: true,
    check,
};

/// No client gives up within this time, in microseconds.
const SOON: u64 = 30_000;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let overtaken: Vec<&Exchange> = node
            .exchanges
            .windows(2)
            .filter(|pair| {
                let [one, other] = pair else {
                    return false;
                };
                let is_soon = other.request.at.micros_since(one.request.at) < SOON;
                let is_other = one.address != other.address || one.is_download != other.is_download;
                let is_early =
                    one.outcome == Outcome::GaveUp && one.end.place == other.request.place;
                // Both requests get their response in the end.
                is_soon
                    && is_other
                    && is_early
                    && (!other.extra.is_empty() || other.outcome == Outcome::Other)
            })
            .flat_map(|pair| pair.iter())
            .collect();
        let [first, .., last] = overtaken[..] else {
            continue;
        };
        found.push(
            Incident::new(
                format!("node {id}: requests come before the response to the one before"),
                first.request.at,
                last.end.at,
            )
            .node(*id)
            .recovered(node.exchanges.last().is_some_and(|last| last.outcome == Outcome::Answered))
            .shows(overtaken.iter().flat_map(|one| [one.request.place, one.end.place]))
            .cause(Cause::new(
                "two-clients",
                format!("two programs use the default SDO of node {id} at once"),
                "which tools and masters are connected: one may use the channel, a second needs an SDO server of its own (1201h)",
            )),
        );
    }
    found
}
