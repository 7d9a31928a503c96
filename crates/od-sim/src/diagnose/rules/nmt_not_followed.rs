//! A start command that a node does not follow.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, after, from};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "nmt-not-followed",
    title: "A node does not follow a start command",
    needs_times: false,
    check,
};

/// A node follows within this time, in microseconds.
const SETTLE: u64 = 100_000;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (number, (seen, code, target)) in facts.commands.iter().enumerate() {
        if *code != 1 {
            continue;
        }
        for (id, node) in &facts.nodes {
            if *target != 0 && target != id {
                continue;
            }
            let settle = if facts.has_times { SETTLE } else { 0 };
            let settled = seen.at.plus_micros(settle);
            let next: Vec<_> = from(&node.states, settled).iter().take(3).collect();
            let until = next.last().map_or(facts.end, |(seen, _)| seen.at);
            let later = facts.commands.get(number + 1..).unwrap_or_default().iter();
            let mut later = later.take_while(|(later, ..)| later.at <= until);
            let is_moved = later.any(|(_, _, other)| *other == 0 || other == id);
            let is_wrong =
                next.len() == 3 && next.iter().all(|(_, state)| !matches!(state & 0x7F, 5 | 0));
            let is_alive = node
                .states
                .first()
                .is_some_and(|(state, _)| state.at < seen.at);
            if is_moved || !is_wrong || !is_alive {
                continue;
            }
            let mut states = after(&node.states, until).iter();
            let back = states.any(|(_, what)| what & 0x7F == 5);
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
