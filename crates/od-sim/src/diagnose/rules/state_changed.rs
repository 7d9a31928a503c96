//! A node that changes its NMT state without a command.

use std::format;
use std::prelude::v1::*;

use od_wire::emcy::text;

use crate::diagnose::facts::{Facts, after as later};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "state-changed",
    title: "A node leaves Operational without a command",
    needs_times: false,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        for pair in node.states.windows(2) {
            let [(before, was), (after, is)] = [pair[0], pair[1]];
            let is_left = was & 0x7F == 5 && matches!(is & 0x7F, 4 | 0x7F);
            if !is_left || facts.commands_to(*id, before.at, after.at).next().is_some() {
                continue;
            }
            let state = if is & 0x7F == 4 {
                "Stopped"
            } else {
                "Pre-operational"
            };
            let mut states = later(&node.states, after.at).iter();
            let is_back = states.any(|(_, state)| state & 0x7F == 5);
            let mut emcys = node.emcys.iter();
            let emcy = emcys.find(|emcy| {
                emcy.code != 0 && emcy.seen.place > before.place && emcy.seen.place < after.place
            });
            let error = emcy.map_or(String::from("an error"), |emcy| {
                format!("the error {:04X}h, {},", emcy.code, text(None, emcy.code))
            });
            found.push(
                Incident::new(
                    format!("node {id} goes to {state} without a command"),
                    before.at,
                    after.at,
                )
                .node(*id)
                .recovered(is_back)
                .shows([before.place, after.place])
                .shows(emcy.map(|emcy| emcy.seen.place))
                .cause(Cause::new(
                    "error-behaviour",
                    format!("{error} of node {id} changes its NMT state (1029h)"),
                    format!("EMCY and 1003h of node {id}, and what 1029h says"),
                )),
            );
        }
    }
    found
}
