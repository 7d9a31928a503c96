//! A start command that a node does not follow.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::Facts;
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "nmt-not-followed",
    title: "A node does not follow a start command",
    check,
};

/// A node follows within this time, in microseconds.
const SETTLE: u64 = 100_000;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (seen, code, target) in &facts.commands {
        if *code != 1 {
            continue;
        }
        for (id, node) in &facts.nodes {
            if *target != 0 && target != id {
                continue;
            }
            let settled = seen.at.plus_micros(SETTLE);
            let next: Vec<_> = node
                .states
                .iter()
                .filter(|(state, _)| state.at >= settled)
                .take(3)
                .collect();
            let until = next.last().map_or(facts.end, |(seen, _)| seen.at);
            let is_moved = facts.commands.iter().any(|(later, _, other)| {
                later.place > seen.place && later.at <= until && (*other == 0 || other == id)
            });
            let is_wrong =
                next.len() == 3 && next.iter().all(|(_, state)| !matches!(state & 0x7F, 5 | 0));
            let is_alive = node.states.iter().any(|(state, _)| state.at < seen.at);
            if is_moved || !is_wrong || !is_alive {
                continue;
            }
            let back = node
                .states
                .iter()
                .any(|(state, what)| state.at > until && what & 0x7F == 5);
            found.push(
                Incident::new(format!("node {id} does not start"), seen.at, until)
                    .node(*id)
                    .recovered(back)
                    .shows([seen.place])
                    .shows(next.iter().map(|(seen, _)| seen.place))
                    .cause(Cause::new(
                        "not-started",
                        format!("an error keeps node {id} from Operational, or it did not receive the command"),
                        format!("1001h and 1003h of node {id}; whether the command came while it started"),
                    )),
            );
        }
    }
    found
}
