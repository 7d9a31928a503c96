//! A node that boots more slowly than its client expects.

use std::format;
use std::prelude::v1::*;

use crate::diagnose::facts::{Exchange, Facts, Node, Outcome, Seen, after, before};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "starts-late",
    title: "A client does not wait for the boot-up message",
    needs_times: false,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let nodes = facts.nodes.iter();
    nodes
        .flat_map(|(id, node)| incidents(facts, *id, node))
        .collect()
}

fn incidents(facts: &Facts<'_>, id: u8, node: &Node) -> Vec<Incident> {
    let mut found = Vec::new();
    for boot in &node.boots {
        // The last reset before the boot-up message, and nothing of the node between them.
        let resets = before(&facts.commands, boot.at).iter().rev();
        let mut resets = resets.filter(|(_, code, target)| {
            matches!(code, 0x81 | 0x82) && (*target == id || *target == 0)
        });
        let Some((reset, ..)) = resets.next() else {
            continue;
        };
        let early = after(before(&node.exchanges, boot.at), reset.at);
        let lost: Vec<&Exchange> = early.iter().filter(|one| is_lost(one, boot)).collect();
        let is_silent = before(after(&node.sent, reset.at), boot.at).is_empty();
        let (Some(first), Some(last)) = (lost.first(), lost.last()) else {
            continue;
        };
        if !is_silent {
            continue;
        }
        let later = after(&node.exchanges, boot.at).iter();
        let is_over = later.clone().any(|one| one.outcome == Outcome::Answered);
        let late = lost
            .iter()
            .flat_map(|one| &one.extra)
            .map(|seen| seen.place);
        found.push(
            Incident::new(
                format!("node {id} is asked before its boot-up message"),
                first.request.at,
                boot.at.max(last.end.at),
            )
            .node(id)
            .recovered(is_over)
            .shows([reset.place, first.request.place, last.end.place, boot.place])
            .shows(late.take(2))
            .cause(Cause::new(
                "starts-late",
                format!("node {id} starts more slowly than its client expects; it answers only after its boot-up message"),
                format!("the boot time-out of the client, or let it wait for the boot-up message of node {id}"),
            )),
        );
    }
    found
}

/// Returns whether a request had no response before a boot-up message.
fn is_lost(one: &Exchange, boot: &Seen) -> bool {
    match one.outcome {
        Outcome::GaveUp | Outcome::Open => true,
        _ => one.end.at > boot.at,
    }
}
