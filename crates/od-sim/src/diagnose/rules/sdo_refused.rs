//! SDO requests that the server refuses.

use std::collections::BTreeMap;
use std::format;
use std::prelude::v1::*;

use od_wire::AbortReason;

use crate::diagnose::facts::{Exchange, Facts, Outcome, after};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

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
            if let Outcome::Refused(code) = one.outcome {
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
                .cause(Cause::new("refused", reason(code, is_download), check)),
            );
        }
    }
    found
}

/// The usual reason of an abort code.
fn reason(code: u32, is_download: bool) -> String {
    let text = match code {
        0x0601_0002 | 0x0601_0000 => {
            "the object cannot be written, or not while its PDO is valid or its mapping is active"
        }
        0x0602_0000 | 0x0609_0011 => {
            "the device does not have the object: another revision than the configuration is for"
        }
        0x0604_0041 | 0x0604_0042 => {
            "the mapping names an object that cannot be mapped, or more than 64 bits"
        }
        0x0607_0010 | 0x0607_0012 | 0x0607_0013 => {
            "the length of the value is not that of the object"
        }
        0x0609_0030..=0x0609_0032 => "the value is outside the range of the object",
        0x0800_0020..=0x0800_0022 if is_download => {
            "the state of the device does not allow the value now"
        }
        _ if is_download => "the device does not accept the value",
        _ => "the client reads what the device does not give",
    };
    text.into()
}
