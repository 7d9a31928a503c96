//! Requests that come back unchanged.

use std::collections::BTreeMap;
use std::format;
use std::prelude::v1::*;

use od_wire::Frame;

use crate::diagnose::facts::{Facts, Seen};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;
use crate::sdo::default_sdo;

pub(super) const RULE: Rule = Rule {
    name: "sdo-echo",
    title: "A node sends SDO requests back",
    needs_times: false,
    check,
};

/// The command byte of an abort, which both sides can send.
const ABORT: u8 = 0x80;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    // The last SDO frame of each node, and its requests that came back.
    let mut last: BTreeMap<u8, (Seen, bool)> = BTreeMap::new();
    let mut echoes: BTreeMap<u8, Vec<[Seen; 2]>> = BTreeMap::new();
    for seen in &facts.frames {
        let Some(frame) = facts.frame(seen.place) else {
            continue;
        };
        let Some((id, is_response)) = default_sdo(frame) else {
            continue;
        };
        if let Some((request, false)) = last.insert(id, (*seen, is_response))
            && is_response
            && facts
                .frame(request.place)
                .is_some_and(|request| is_echo(request, frame))
        {
            echoes.entry(id).or_default().push([request, *seen]);
        }
    }
    let found = echoes.iter().filter_map(|(id, all)| {
        let [[first, _], .., [_, end]] = all[..] else {
            return None;
        };
        let is_over = last.get(id).is_some_and(|(seen, is_response)| *is_response && seen.place > end.place);
        let incident = Incident::new(
            format!("node {id} sends {} SDO requests back unchanged", all.len()),
            first.at,
            end.at,
        );
        Some(
            incident
                .node(*id)
                .recovered(is_over)
                .shows(all.iter().take(3).flatten().map(|seen| seen.place))
                .cause(Cause::new(
                    "echo",
                    format!("the SDO server of node {id} sends what is in its buffer: it does not know the command, such as a segment of a block"),
                    format!("whether node {id} supports block transfer, and which frame its server sends for a segment"),
                )),
        )
    });
    found.collect()
}

/// Returns whether a response has the bytes of its request, which no server sends; both sides can abort.
fn is_echo(request: &Frame, response: &Frame) -> bool {
    request.bytes()[0] != ABORT && request.dlc() == 8 && request.data() == response.data()
}
