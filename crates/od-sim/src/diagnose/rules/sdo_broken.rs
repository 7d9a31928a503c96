//! SDO transfers that end with an error of the protocol.

use std::format;
use std::prelude::v1::*;

use od_wire::AbortReason;

use crate::diagnose::facts::{Exchange, Facts, Outcome, Seen, after};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "sdo-broken",
    title: "An SDO transfer ends with an error of the protocol",
    needs_times: false,
    check,
};

/// Returns whether an abort code says that the other side does not keep the protocol of a transfer (CiA 301, table 22).
pub(super) const fn is_one(code: u32) -> bool {
    matches!(code, 0x0503_0000 | 0x0504_0002..=0x0504_0005)
}

/// The abort of a transfer, with its code, and whether the client sent it.
fn abort(one: &Exchange) -> Option<(Seen, u32, bool)> {
    let by_server = match one.outcome {
        Outcome::Refused(code) => Some((one.end, code, false)),
        _ => None,
    };
    let by_client = one.aborted.map(|(seen, code)| (seen, code, true));
    by_server.or(by_client).filter(|(_, code, _)| is_one(*code))
}

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let all = node.exchanges.iter();
        let broken: Vec<_> = all.filter_map(|one| Some((one, abort(one)?))).collect();
        for group in broken.chunk_by(|a, b| (a.1.1, a.1.2) == (b.1.1, b.1.2)) {
            let ([(first, (_, code, by_client)), ..], [.., (_, (last, ..))]) = (group, group)
            else {
                continue;
            };
            let object = first
                .address
                .map_or_else(|| String::from("an object"), |address| address.to_string());
            let who = if *by_client {
                "the client"
            } else {
                "the server"
            };
            let mut later = after(&node.exchanges, last.at).iter();
            let is_over = later.any(|one| {
                one.address == first.address
                    && one.outcome == Outcome::Answered
                    && abort(one).is_none()
            });
            let text = format!(
                "node {id}: {who} aborts the transfer of {object}: {code:08X}h, {}",
                AbortReason(*code).text()
            );
            found.push(
                Incident::new(text, first.request.at, last.at)
                    .node(*id)
                    .recovered(is_over)
                    .shows(group.iter().take(3).flat_map(|(one, (seen, ..))| {
                        [one.request.place, one.end.place, seen.place]
                    }))
                    .cause(cause(*id, *code, *by_client)),
            );
        }
    }
    found
}

fn cause(id: u8, code: u32, by_client: bool) -> Cause {
    let (good, bad) = if by_client {
        ("the client", format!("the SDO server of node {id}"))
    } else {
        ("the server", String::from("the client"))
    };
    match code {
        0x0503_0000 => Cause::new(
            "toggle-bit",
            format!(
                "{bad} does not alternate the toggle bit of its segments, or a segment was lost or repeated"
            ),
            format!(
                "bit 4 of the first byte in the frames below; whether the CAN driver of {bad} loses or repeats frames"
            ),
        ),
        0x0504_0004 => Cause::new(
            "block-checksum",
            format!("{good} has other bytes than {bad}, or one of them computes the CRC otherwise"),
            "the CRC of CiA 301, 7.2.4.3.16 (16 bits, polynomial 1021h, start value 0), without the unused bytes of the last segment",
        ),
        0x0504_0005 => Cause::new(
            "out-of-memory",
            format!("the value is longer than the buffer of {good}"),
            format!("the length that the transfer announces against the buffer of {good}"),
        ),
        _ => Cause::new(
            "block-segments",
            format!("{bad} counts the segments of a block otherwise, or segments were lost"),
            "the number in each segment (1 to the block size), and whether the receiver keeps up with segments without a pause",
        ),
    }
}
