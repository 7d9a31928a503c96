//! A CAN controller with too many errors: error passive, bus-off, lost frames.

use std::format;
use std::prelude::v1::*;

use od_wire::emcy::text;

use crate::diagnose::facts::Facts;
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "bus-off",
    title: "A node's CAN controller has errors",
    needs_times: false,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        // From an error to the message that all are over.
        for group in node.emcys.split_inclusive(|emcy| emcy.code == 0) {
            let mut own = group
                .iter()
                .filter(|emcy| matches!(emcy.code, 0x8110 | 0x8120 | 0x8140));
            let Some(emcy) = own.next() else {
                continue;
            };
            let last = own.next_back().unwrap_or(emcy);
            let ended = group.last().filter(|last| last.code == 0);
            let cause = if emcy.code == 0x8110 {
                Cause::new(
                    "overrun",
                    format!(
                        "node {id} loses frames: it takes them too slowly, or cannot send its own"
                    ),
                    format!(
                        "acceptance filters and interrupt load of node {id}, bursts on the bus, and whether a node acknowledges its frames"
                    ),
                )
            } else {
                Cause::new(
                    "controller-errors",
                    format!(
                        "node {id} has seen many errors, the others have not: its own connection is bad"
                    ),
                    format!(
                        "connector, stub and ground of node {id}, then its bit timing (sample point)"
                    ),
                )
            };
            found.push(
                Incident::new(
                    format!(
                        "node {id} reports {:04X}h, {}",
                        emcy.code,
                        text(None, emcy.code)
                    ),
                    emcy.seen.at,
                    ended.unwrap_or(last).seen.at,
                )
                .node(*id)
                .recovered(ended.is_some() || last.code == 0x8140)
                .shows([emcy.seen.place, last.seen.place])
                .cause(cause),
            );
        }
    }
    found
}
