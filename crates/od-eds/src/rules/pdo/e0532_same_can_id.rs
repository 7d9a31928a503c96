use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::rules::pdo::cob_ids::{CobId, Service, cob_ids};

pub(crate) static E0532: Rule = Rule {
    title: "two services have the same CAN-ID",
    why: "Two devices send with the same CAN-ID, which ends in bus errors, or a device takes the message of one service for that of the other.",
    source: "CiA 301, COB-ID and predefined connection set",
    says: "{object} has CAN-ID {id}, which is that of {other}",
    help: "write {right}{fix}, or set bit 31 (`0x80000000`) if the service is not used",
    also: &[ONE, DEFAULT, DEFAULT_ONE, SHARED],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("E0532")
};

/// Sentence for the CAN-ID of a service by the predefined connection set.
const DEFAULT: Form = Form {
    says: "{object} has CAN-ID {id}, which {other} messages have by default",
    ..Form::OWN
};

/// Sentence for a fixed number that equals a COB-ID with `$NODEID` at one node ID.
const ONE: Form = Form {
    says: "{object} has the CAN-ID of {other}, {can:03X}h, at node ID {node}",
    ..Form::OWN
};

/// The same for a CAN-ID of the predefined connection set.
const DEFAULT_ONE: Form = Form {
    says: "{object} has CAN-ID {can:03X}h at node ID {node}, which {other} messages have by default",
    ..Form::OWN
};

/// Sentence for a COB-ID that all nodes must share.
const SHARED: Form = Form {
    says: "{object} has CAN-ID {id}, but all nodes share the CAN-ID of SYNC and TIME",
    help: "write {right}{fix}; it is a number without `$NODEID`",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let mut all: Vec<CobId<'_>> = cob_ids(description).collect();
    // The one that is at its default keeps its CAN-ID.
    all.sort_by_key(|cob_id| (!cob_id.is_default(), cob_id.service, cob_id.entry.address));
    for (number, cob_id) in all.iter().enumerate() {
        let about = |other: Fact| {
            let finding = cob_id.finding(&E0532).fact("object", cob_id.entry.shown());
            finding.fact("other", other)
        };
        let at = |finding: Finding, node, form| {
            let finding = finding.form(form).fact("node", node);
            finding.fact("can", cob_id.can_id(node))
        };
        if cob_id.formula && matches!(cob_id.service, Service::Sync | Service::Time) {
            let finding = cob_id.finding(&E0532).fact("object", cob_id.entry.shown());
            let finding = finding.fact("id", cob_id.shown()).form(&SHARED);
            findings.push(cob_id.with_default(finding, &all));
            continue;
        }
        let before = all[..number].iter().filter(|other| collide(other, cob_id));
        let mut met = before.filter_map(|other| Some((other, cob_id.meets(other)?)));
        let same = met.clone().find(|(other, _)| cob_id.is_same(other));
        let finding = match (same, by_default(cob_id, &all)) {
            (Some((other, _)), _) => about(other.entry.shown())
                .fact("id", cob_id.shown())
                .related(other.span, "used here"),
            (None, Some((node, service))) if cob_id.formula => {
                at(about(service.into()), node, &DEFAULT_ONE)
            }
            (None, Some((_, service))) => about(service.into())
                .fact("id", cob_id.shown())
                .form(&DEFAULT),
            (None, None) => match met.next() {
                Some((other, node)) => {
                    at(about(other.entry.shown()), node, &ONE).related(other.span, "used here")
                }
                None => continue,
            },
        };
        findings.push(cob_id.with_default(finding, &all));
    }
}

/// The first node ID for which the pre-defined connection set gives the CAN-ID to another service,
/// and that service.
fn by_default(cob_id: &CobId<'_>, all: &[CobId<'_>]) -> Option<(u8, &'static str)> {
    let has = |service| all.iter().any(|other| other.service == service);
    if cob_id.extended {
        return None;
    }
    // A client of the node's own server.
    let is_own = |node| [0x580, 0x600].contains(&cob_id.can_id(node).wrapping_sub(u32::from(node)));
    if cob_id.service == Service::SdoClient && cob_id.nodes().all(is_own) {
        return Some((*cob_id.nodes().start(), "the node's own SDO"));
    }
    let (no_sync, no_time) = (!has(Service::Sync), !has(Service::Time));
    cob_id.nodes().find_map(|node| {
        let service = match cob_id.can_id(node) {
            0x80 if cob_id.service != Service::Sync && no_sync => "SYNC",
            0x100 if cob_id.service != Service::Time && no_time => "TIME",
            0x81..=0xFF if cob_id.service > Service::EmcyConsumer => "EMCY",
            0x181..=0x57F if cob_id.service < Service::Emcy => "PDO",
            _ => return None,
        };
        Some((node, service))
    })
}

/// Returns whether these two must not have the same CAN-ID. Two PDOs have their own rule, and two
/// consumers may share a CAN-ID.
fn collide(a: &CobId<'_>, b: &CobId<'_>) -> bool {
    let consumes = |cob_id: &CobId<'_>| cob_id.service == Service::EmcyConsumer;
    let pdos = a.is_pdo() && b.is_pdo();
    // An entry of 1028h is the CAN-ID of another device's EMCY, never that of a SYNC or TIME.
    let shared = |cob_id: &CobId<'_>| matches!(cob_id.service, Service::Sync | Service::Time);
    !pdos && (!consumes(a) || shared(b)) && (!consumes(b) || shared(a))
}
