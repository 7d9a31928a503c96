//! Errors that a device reports about itself.

use std::format;
use std::prelude::v1::*;

use od_wire::emcy::text;

use crate::diagnose::facts::{Emcy, Facts};
use crate::diagnose::incident::{Cause, Incident};
use crate::diagnose::rule::Rule;

pub(super) const RULE: Rule = Rule {
    name: "emcy",
    title: "A device reports an error",
    needs_times: false,
    check,
};

fn check(facts: &Facts<'_>) -> Vec<Incident> {
    let mut found = Vec::new();
    for (id, node) in &facts.nodes {
        // From an error to the message that all errors have ended.
        for group in node.emcys.split_inclusive(|emcy| emcy.code == 0) {
            let errors: Vec<&Emcy> = group.iter().filter(|emcy| emcy.code != 0).collect();
            let (Some(first), Some(last)) = (errors.first(), group.last()) else {
                continue;
            };
            let meaning = text(None, first.code);
            found.push(
                Incident::new(
                    format!("node {id} reports {:04X}h, {meaning}", first.code),
                    first.seen.at,
                    last.seen.at,
                )
                .node(*id)
                .recovered(last.code == 0)
                .shows(group.iter().map(|emcy| emcy.seen.place))
                .cause(cause(*id, first.code, meaning)),
            );
        }
    }
    found
}

fn cause(id: u8, code: u16, meaning: &str) -> Cause {
    match code {
        // CiA 301, table 26: life guard error or heartbeat error.
        0x8130 => Cause::new(
            "error-control",
            format!("node {id} waited too long for a heartbeat or for a guarding request"),
            format!(
                "whether the other node has power; 1016h of node {id} against 1017h of the other, or 100Ch and 100Dh against the master"
            ),
        ),
        _ => Cause::new(
            "device-error",
            format!("the device has an error of its own: {meaning}"),
            format!("the manual of node {id} for code {code:04X}h, and its history 1003h"),
        ),
    }
}
