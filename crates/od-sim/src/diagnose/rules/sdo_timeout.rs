//! SDO requests without a response in time.

use std::format;
use std::prelude::v1::*;

use od_wire::Frame;

use crate::diagnose::facts::{Exchange, Facts, Node, Outcome, after, from, millis, until};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;
use crate::words::bytes;

pub(super) const RULE: Rule = Rule {
    name: "sdo-timeout",
    title: "An SDO request has no response in time",
    needs_times: false,
    check,
};

/// Failures this far apart are one incident, in microseconds.
const APART: u64 = 10_000_000;

/// A client that asks so many node IDs without a node for one object looks for nodes.
const SEARCH: usize = 4;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let failed: Vec<&Exchange> = node
            .exchanges
            .iter()
            .filter(|one| is_failed(facts, one) && !is_search(facts, node, one))
            .collect();
        for group in failed.chunk_by(|a, b| b.request.at.micros_since(a.request.at) <= APART) {
            found.extend(incident(facts, *id, node, group));
        }
    }
    found
}

/// Returns whether a request without a response is one of a search: other node IDs that sent nothing got it, too, and each
/// no other request.
fn is_search(facts: &Facts<'_>, node: &Node, one: &Exchange) -> bool {
    let is_asked = |node: &Node| match &node.exchanges[..] {
        [only] => {
            let [first, last] = [
                only.request.at.min(one.request.at),
                only.request.at.max(one.request.at),
            ];
            only.address == one.address && !only.is_download && last.micros_since(first) <= APART
        }
        _ => false,
    };
    let absent = facts.nodes.values().filter(|node| node.sent.is_empty());
    node.sent.is_empty() && is_asked(node) && absent.filter(|node| is_asked(node)).count() >= SEARCH
}

fn is_failed(facts: &Facts<'_>, one: &Exchange) -> bool {
    match one.outcome {
        Outcome::GaveUp | Outcome::Other => true,
        // The log may end before the response.
        Outcome::Open => facts.has_times && facts.end.micros_since(one.request.at) > 500_000,
        Outcome::Answered | Outcome::Refused(_) => false,
    }
}

/// Returns whether a frame on the CAN-ID of requests is one that only a server sends: with a value in it, or a confirmation
/// that names an object (CiA 301, 7.2.4.3).
fn is_response(frame: &Frame) -> bool {
    let [command, low, high, sub, value @ ..] = *frame.bytes();
    match command >> 5 {
        2 => command & 0x1F != 0 || value != [0; 4],
        3 => [low, high, sub] != [0; 3],
        _ => false,
    }
}

fn incident(facts: &Facts<'_>, id: u8, node: &Node, group: &[&Exchange]) -> Option<Incident> {
    let (first, last) = (group.first()?, group.last()?);
    let count = group.len();
    let text = format!(
        "node {id}: {count} SDO {} no response in time",
        if count == 1 {
            "request has"
        } else {
            "requests have"
        }
    );
    let mut later = after(&node.exchanges, last.request.at).iter();
    let is_over = later.any(|one| matches!(one.outcome, Outcome::Answered | Outcome::Refused(_)));
    let late = group.iter().find_map(|one| Some((one, one.extra.first()?)));
    let other = group.iter().find(|one| one.outcome == Outcome::Other);
    let is_known = !node.sent.is_empty();
    let state = until(&node.states, first.request.at).last();
    let is_stopped = state.is_some_and(|(_, state)| state & 0x7F == 4);
    let begin = first.request.at;
    let soon = last.end.at.plus_micros(1_000_000);
    let is_alive = !from(until(&node.sent, soon), begin).is_empty();
    let requests = || {
        group
            .iter()
            .filter_map(|one| facts.frame(one.request.place))
    };
    let shortest = requests().map(|frame| frame.dlc()).min().unwrap_or(8);
    let cause = if requests().any(is_response) {
        Cause::new(
            "response-on-request-id",
            format!(
                "node {id} sends its responses on {:X}h, the CAN-ID of requests; its client waits for {:X}h",
                0x600 + u16::from(id),
                0x580 + u16::from(id)
            ),
            format!("1200h of node {id} and the CAN-ID that its firmware sends with"),
        )
    } else if shortest < 8 {
        Cause::new(
            "short-request",
            format!(
                "a request has {}, but an SDO message has 8, and many servers ignore a shorter one",
                bytes(shortest.into())
            ),
            "the number of bytes that the client sends; bytes without a meaning are 0",
        )
    } else if other.is_some() {
        Cause::new(
            "other-response",
            format!(
                "node {id} responds about another object: the response to an earlier request, or of another client"
            ),
            "whether two programs use the channel, or the client's time-out is too short",
        )
    } else if let Some((one, extra)) = late {
        Cause::new(
            "late-response",
            if facts.has_times {
                format!(
                    "node {id} responds after {}, and the client waits for {}",
                    millis(extra.at.micros_since(one.request.at)),
                    millis(one.end.at.micros_since(one.request.at))
                )
            } else {
                format!("node {id} responds only after the client has given up")
            },
            "the time-out of the client: some objects take long (save, restore, block transfers)",
        )
    } else if is_stopped {
        Cause::new(
            "stopped",
            format!("node {id} is in Stopped, where SDO does not work"),
            format!("the NMT command to node {id}: enter Pre-operational first"),
        )
    } else if !is_known {
        Cause::new(
            "node-missing",
            format!(
                "no frame of node {id} is in the log: it is off, not connected, or has another node ID or bit rate"
            ),
            "power of the device, its node ID (`odkit scan`), its bit rate; the client may use a wrong node ID",
        )
    } else if is_alive {
        Cause::new(
            "server-silent",
            format!(
                "node {id} is alive and does not respond: its SDO server is busy, or its COB-IDs were changed"
            ),
            format!("1200h of node {id}, and what its firmware does at this time"),
        )
    } else {
        Cause::new(
            "connection",
            format!("node {id} fell silent: it has no power, or its cable came loose"),
            format!("power and connector of node {id}"),
        )
    };
    let mut incident = Incident::new(text, begin, last.end.at)
        .node(id)
        .recovered(is_over)
        .shows(
            group
                .iter()
                .take(3)
                .flat_map(|one| [one.request.place, one.end.place]),
        )
        .shows(late.map(|(_, extra)| extra.place))
        .cause(cause);
    if !is_known {
        incident = incident.cause(Cause::new(
            "bit-rate",
            format!("node {id} has another bit rate, and its controller has gone bus-off"),
            "the bit rate of the device, with only the device on a bus and each rate in turn",
        ));
    }
    Some(incident)
}
