//! A PDO whose length differs from the mapping of its consumer or of its EDS.

use std::format;
use std::prelude::v1::*;

use od_model::Address;

use crate::diagnose::facts::{Facts, Seen};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "mapping-differs",
    title: "Producer and consumer of a PDO map it otherwise",
    needs_times: false,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = consumers(facts);
    found.extend(by_mapping(facts));
    found
}

/// Consumers that report the length of a PDO.
fn consumers(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        let own = node
            .emcys
            .iter()
            .filter(|emcy| matches!(emcy.code, 0x8210 | 0x8220));
        let own: Vec<Seen> = own.map(|emcy| emcy.seen).collect();
        let [first, ..] = own[..] else {
            continue;
        };
        let last = own[own.len() - 1];
        // The PDO just before the message.
        let before = facts
            .pdos
            .values()
            .flatten()
            .filter(|seen| seen.place < first.place);
        let pdo = before.max_by_key(|seen| seen.place);
        let name = pdo.and_then(|seen| facts.frame(seen.place));
        let name = name.map_or(String::from("an RPDO"), |frame| {
            format!("{:03X}h with {} bytes", frame.id().raw(), frame.dlc())
        });
        let ended = node
            .emcys
            .iter()
            .any(|emcy| emcy.code == 0 && emcy.seen.at >= last.at);
        found.push(
            Incident::new(
                format!("node {id} does not process {name}: length error"),
                first.at,
                last.at,
            )
            .node(*id)
            .recovered(ended)
            .shows(pdo.map(|seen| seen.place))
            .shows(own.iter().take(3).map(|seen| seen.place))
            .cause(Cause::new(
                "mapping-differs",
                format!("{name} is not what node {id} maps"),
                format!("the mapping of the producer's TPDO against 1600h and up of node {id}"),
            )),
        );
    }
    found
}

/// Compares PDOs with the mapping of the EDS and the values that clients wrote.
fn by_mapping(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    let ids: Vec<u8> = (1..=127)
        .filter(|id| facts.dictionary(*id).is_some())
        .collect();
    for id in ids {
        for base in [0x1400u16, 0x1800] {
            let is_tpdo = base == 0x1800;
            for number in 0..512u16 {
                let com = Address::new(base + number, 1);
                let Some(cob_id) = facts.value(id, com, facts.end) else {
                    // PDOs are numbered from 1; few devices have gaps.
                    if number > 8 { break } else { continue }
                };
                if cob_id & 1 << 31 != 0 {
                    continue;
                }
                let Some(seen) = facts.pdos.get(&((cob_id & 0x7FF) as u16)) else {
                    continue;
                };
                let Some(bits) = mapped(facts, id, base + number + 0x200) else {
                    continue;
                };
                let wanted = bits.div_ceil(8);
                // A mapping that was changed during the log applies only to a part of it.
                let node = facts.nodes.get(&id);
                let is_changed = node.is_some_and(|node| {
                    node.is_written(base + number + 0x200, facts.begin, facts.end)
                });
                let is_wrong = |seen: &&Seen| {
                    let dlc = facts
                        .frame(seen.place)
                        .map_or(0, |frame| u32::from(frame.dlc()));
                    if is_tpdo { dlc != wanted } else { dlc < wanted }
                };
                let wrong: Vec<Seen> = seen.iter().filter(is_wrong).copied().collect();
                let [first, ..] = wrong[..] else {
                    continue;
                };
                if is_changed && is_tpdo || wanted == 0 {
                    continue;
                }
                let last = wrong[wrong.len() - 1];
                let dlc = facts.frame(first.place).map_or(0, od_wire::Frame::dlc);
                let word = if is_tpdo { "TPDO" } else { "RPDO" };
                let text = format!(
                    "{:03X}h has {dlc} bytes, {word}{} of node {id} maps {wanted}",
                    cob_id & 0x7FF,
                    number + 1
                );
                found.push(
                    Incident::new(text, first.at, last.at)
                        .node(id)
                        .shows(wrong.iter().take(3).map(|seen| seen.place))
                        .cause(Cause::new(
                            "mapping-differs",
                            format!("the mapping of {word}{} of node {id} is not that of the other side", number + 1),
                            format!("{:04X}h of node {id}: the EDS, and what the device has", base + number + 0x200),
                        )),
                );
            }
        }
    }
    found
}

/// Bits of a mapping; `None` if it is not known.
fn mapped(facts: &Facts<'_>, id: u8, map: u16) -> Option<u32> {
    let count = facts.value(id, Address::new(map, 0), facts.end)?;
    let subs = 1..=count.min(64) as u8;
    let bits = subs.map(|sub| {
        facts
            .value(id, Address::new(map, sub), facts.end)
            .map(|raw| raw & 0xFF)
    });
    bits.sum()
}
