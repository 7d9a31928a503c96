//! Node guarding without responses, and life guarding that a master ended.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Facts, after, before, from, median_interval, millis};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "guarding",
    title: "Node guarding fails",
    needs_times: true,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let silent: Vec<_> = node
            .guards
            .windows(2)
            .filter(|pair| before(from(&node.states, pair[0].at), pair[1].at).is_empty())
            .map(|pair| pair[0])
            .collect();
        if let [first, .., last] = silent[..] {
            let is_back = !after(&node.states, last.at).is_empty();
            found.push(
                Incident::new(
                    format!("node {id} does not respond to {} guarding requests", silent.len()),
                    first.at,
                    last.at,
                )
                .node(*id)
                .recovered(is_back)
                .shows(silent.iter().map(|seen| seen.place))
                .cause(Cause::new(
                    "connection",
                    format!("node {id} has no power or is not connected"),
                    format!("power and connector of node {id}; whether it supports node guarding (100Ch in its EDS)"),
                )),
            );
        }
        // EMCY 8130h of the guarded node itself: its master stopped guarding.
        let period = median_interval(&node.guards);
        for emcy in node.emcys.iter().filter(|emcy| emcy.code == 0x8130) {
            let last = before(&node.guards, emcy.seen.at).last();
            let Some(last) = last.filter(|_| node.guards.len() >= 3) else {
                continue;
            };
            let pause = emcy.seen.at.micros_since(last.at);
            if pause > period * 3 / 2 {
                let next = after(&node.guards, emcy.seen.at).first();
                found.push(
                    Incident::new(
                        format!("node {id} was not guarded for {}", millis(pause)),
                        last.at,
                        next.map_or(emcy.seen.at, |next| next.at),
                    )
                    .node(*id)
                    .recovered(next.is_some())
                    .shows([last.place, emcy.seen.place])
                    .cause(Cause::new(
                        "master-stopped",
                        format!("the master stopped guarding node {id}"),
                        format!("the master's task, or its guard time against 100Ch times 100Dh of node {id}"),
                    )),
                );
            }
        }
    }
    found
}
