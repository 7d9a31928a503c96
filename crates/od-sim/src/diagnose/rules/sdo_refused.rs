//! SDO requests that the server refuses.

use std::collections::BTreeMap;
use std::format;
use std::prelude::v1::*;

use od_model::Address;
use od_wire::AbortReason;

use crate::diagnose::facts::{Exchange, Facts, Outcome, after, until};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;
use crate::diagnose::rules::sdo_broken;

pub(super) const RULE: Rule = Rule {
    name: "sdo-refused",
    title: "A node refuses a value, or the same read again and again",
    needs_times: false,
    check,
};

/// Refusals this far apart are one incident, in microseconds.
const APART: u64 = 10_000_000;
/// A probe reads an object that may be missing once, and perhaps once more. A client that needs it reads it as often as this.
const READS: usize = 3;

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        // The refusals of an object for one reason.
        let mut refused: BTreeMap<_, Vec<&Exchange>> = BTreeMap::new();
        for one in &node.exchanges {
            if let Outcome::Refused(code) = one.outcome
                && !sdo_broken::is_one(code)
            {
                let key = (one.is_download, one.address, code);
                refused.entry(key).or_default().push(one);
            }
        }
        let is_near =
            |a: &&Exchange, b: &&Exchange| b.request.at.micros_since(a.request.at) <= APART;
        let groups = refused
            .iter()
            .flat_map(|((_, _, code), all)| all.chunk_by(is_near).map(|group| (*code, group)));
        for (code, group) in groups {
            let (Some(first), Some(last)) = (group.first(), group.last()) else {
                continue;
            };
            let is_download = first.is_download;
            if !is_download && group.len() < READS {
                continue;
            }
            let object = first
                .address
                .map_or(String::from("an object"), |address| address.to_string());
            let meaning = AbortReason(code).text();
            let is_accepted = after(&node.exchanges, last.request.at).iter().any(|one| {
                one.is_download == is_download
                    && one.address == first.address
                    && one.outcome == Outcome::Answered
            });
            // The client used a segmented transfer then.
            if is_accepted && code == COMMAND && is_block(facts, first) {
                continue;
            }
            let what = if is_download {
                format!("a value for {object}")
            } else {
                format!("to read {object} {} times", group.len())
            };
            let check = if is_download {
                format!("the value against the EDS of node {id}, and the order of the writes")
            } else {
                format!(
                    "what the client reads against the objects of node {id}: its EDS may be of another device"
                )
            };
            found.push(
                Incident::new(
                    format!("node {id} refuses {what}: {code:08X}h, {meaning}"),
                    first.request.at,
                    last.end.at,
                )
                .node(*id)
                .recovered(is_accepted)
                .shows(
                    group
                        .iter()
                        .take(3)
                        .flat_map(|one| [one.request.place, one.end.place]),
                )
                .cause(match code {
                    COMMAND => command(facts, *id, first),
                    _ => Cause::new(
                        "refused",
                        reason(facts, code, first, &node.exchanges),
                        check,
                    ),
                }),
            );
        }
    }
    found
}

/// Abort code: command specifier not valid or unknown.
const COMMAND: u32 = 0x0504_0001;

fn command_byte(facts: &Facts<'_>, one: &Exchange) -> u8 {
    facts
        .frame(one.request.place)
        .map_or(0, |frame| frame.bytes()[0])
}

/// Returns whether a request begins a block transfer.
fn is_block(facts: &Facts<'_>, one: &Exchange) -> bool {
    matches!(command_byte(facts, one) & 0xE3, 0xC0 | 0xC2 | 0xA0)
}

/// The cause of a refused command byte.
fn command(facts: &Facts<'_>, id: u8, one: &Exchange) -> Cause {
    let byte = command_byte(facts, one);
    if is_block(facts, one) {
        return Cause::new(
            "no-block-transfer",
            format!("the SDO server of node {id} does not support block transfer"),
            "the setting of the client for block transfer; it must use a segmented transfer here",
        );
    }
    // Segments: 0 (download) and 3 (upload), with bits that are always 0.
    let is_segment = byte >> 5 == 0 || matches!(byte, 0x60 | 0x70);
    if is_segment {
        return Cause::new(
            "segment-without-transfer",
            format!(
                "the client sends a segment, and node {id} has no transfer open, or waits for another segment"
            ),
            "whether the node was reset, or another client began a transfer, or the client repeats a segment",
        );
    }
    Cause::new(
        "command-byte",
        format!(
            "the client sends the command byte {byte:02X}h, which CiA 301 does not define, or not in this place"
        ),
        "the SDO client: 60h and 70h request a segment, 40h begins an upload, and reserved bits are 0",
    )
}

/// The usual reason of an abort code.
fn reason(facts: &Facts<'_>, code: u32, one: &Exchange, all: &[Exchange]) -> String {
    let is_download = one.is_download;
    let text = match (code, one.address) {
        (0x0607_0010 | 0x0607_0012 | 0x0607_0013, _) => {
            if let Some((announced, sent)) = lengths(facts, one, all).filter(|(a, b)| a != b) {
                return format!(
                    "the client announces {announced} bytes, and its segments have {sent}: bits 1 to 3 of the last segment say how many bytes are not used"
                );
            }
            "the length of the value is not that of the object"
        }
        // CiA 301, 7.5.2.4: a higher value is aborted.
        (
            _,
            Some(Address {
                index: 0x1003,
                sub: 0,
            }),
        ) if is_download => "1003h:00 accepts only 0, which clears the error history",
        (0x0800_0020, Some(Address { index: 0x1010, .. })) if is_download => {
            "the signature is wrong: 1010h accepts 65766173h, \"save\""
        }
        (0x0800_0020, Some(Address { index: 0x1011, .. })) if is_download => {
            "the signature is wrong: 1011h accepts 64616F6Ch, \"load\""
        }
        (0x0601_0002 | 0x0601_0000, _) => {
            "the object cannot be written, or not while its PDO is valid or its mapping is active"
        }
        (0x0602_0000 | 0x0609_0011, _) => {
            "the device does not have the object: another revision than the configuration is for"
        }
        (0x0604_0041 | 0x0604_0042, _) => {
            "the mapping names an object that cannot be mapped, or more than 64 bits"
        }
        (0x0609_0030..=0x0609_0032, _) => "the value is outside the range of the object",
        (0x0800_0020..=0x0800_0022, _) if is_download => {
            "the state of the device does not allow the value now"
        }
        _ if is_download => "the device does not accept the value",
        _ => "the client reads what the device does not give",
    };
    text.into()
}

/// The length that a segmented download announced, and that of its segments up to a request.
fn lengths(facts: &Facts<'_>, last: &Exchange, all: &[Exchange]) -> Option<(u32, u32)> {
    let mut sent = 0;
    for one in until(all, last.request.at).iter().rev() {
        let [command, _, _, _, size @ ..] = *facts.frame(one.request.place)?.bytes();
        match command {
            0x00..=0x1F => sent += 7 - u32::from(command >> 1 & 7),
            0x21 => return Some((u32::from_le_bytes(size), sent)),
            _ => return None,
        }
    }
    None
}
