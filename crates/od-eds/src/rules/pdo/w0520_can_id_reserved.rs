use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule, Severity::Error};
use crate::fix::Fix;
use crate::rules::pdo::cob_ids::{CobId, Service, cob_ids};
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0520: Rule = Rule {
    severity: Error,
    title: "CAN-ID is reserved for another service",
    why: "A message with a CAN-ID of NMT, SDO, error control or LSS disturbs that service in all devices of the network.",
    source: "CiA 301, restricted CAN-IDs",
    fixability: Fixability::Unsafe,
    says: "CAN-ID {id} is one of {first:03X}h to {last:03X}h, which CiA 301 reserves for {service}",
    help: "write {right}{fix}; CiA 301 leaves `0x181` to `0x57F` free for PDOs",
    also: &[WITHOUT_NODE_ID, NMT, SDO, SERVICE, SOME],
    check: Check::Device(check),
    ..Rule::of("W0520")
};

/// Sentence for the CAN-ID of NMT commands.
const NMT: Form = Form {
    says: "CAN-ID 000h is that of NMT",
    help: "write {right}{fix}, or set bit 31 (`0x80000000`) if it is not used",
};

/// The help for another SDO than the default one.
const SDO: Form = Form {
    help: "write a CAN-ID that CiA 301 leaves free, such as `0x680` to `0x6DF` for another SDO",
    ..Form::OWN
};

/// The help for another service than PDOs and SDOs.
const SERVICE: Form = Form {
    help: "write {right}{fix}; that of SYNC is usually `0x80`, of TIME `0x100`, and of EMCY `$NODEID+0x80`",
    ..Form::OWN
};

/// The help for the COB-ID of the first TPDO without the node ID.
const WITHOUT_NODE_ID: Form = Form {
    help: "write `$NODEID+0x{value:X}`, which gives each node a CAN-ID of its own{fix}",
    ..Form::OWN
};

/// Sentence for a CAN-ID that is free for some node IDs only.
const SOME: Form = Form {
    says: "a node with node ID {node} {verb} CAN-ID {can:03X}h, which CiA 301 reserves for {service}",
    help: "write {right}{fix}, so that the CAN-ID of node IDs 1 to 127 is free, or set bit 31 (`0x80000000`)",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let all: Vec<CobId<'_>> = cob_ids(description).collect();
    for cob_id in &all {
        // A client, a consumer or a PDO without mapping is not used if its COB-ID is 0.
        let is_idle = match cob_id.service {
            Service::SdoClient | Service::EmcyConsumer => true,
            Service::Rpdo | Service::Tpdo => maps_nothing(description, cob_id.entry.address.index),
            _ => false,
        };
        let unused = cob_id.identifier == 0 && !cob_id.formula && is_idle;
        findings.extend(finding(cob_id, &all).filter(|_| !unused));
    }
}

fn finding(cob_id: &CobId<'_>, all: &[CobId<'_>]) -> Option<Finding> {
    let reserved = |node| Some((node, cob_id.reserved(node)?));
    let (node, (range, owner)) = cob_id.nodes().find_map(reserved)?;
    let finding = cob_id.finding(&W0520);
    if cob_id.identifier == 0 && !cob_id.formula {
        return Some(cob_id.with_default(finding.form(&NMT), all));
    }
    let finding = finding.fact("service", owner.name());
    if !cob_id.nodes().all(|node| cob_id.reserved(node).is_some()) {
        let finding = finding.form(&SOME).fact("node", node);
        let finding = finding.fact("can", cob_id.can_id(node));
        let finding = finding.fact("verb", cob_id.direction().verb());
        return Some(cob_id.with_default(finding, all));
    }
    let finding = finding.fact("id", cob_id.shown());
    let finding = finding
        .fact("first", *range.start())
        .fact("last", *range.end());
    Some(match cob_id.identifier {
        0x180 if !cob_id.formula => {
            let right = format!("$NODEID+0x{:X}", cob_id.value);
            let fix = Fix::unsafe_fix().replace(cob_id.span, right);
            let finding = finding.form(&WITHOUT_NODE_ID);
            finding.fact("value", cob_id.value).fix(fix)
        }
        _ if cob_id.is_pdo() => cob_id.with_default(finding, all),
        _ if matches!(cob_id.service, Service::SdoServer | Service::SdoClient) => {
            finding.form(&SDO)
        }
        _ => cob_id.with_default(finding.form(&SERVICE), all),
    })
}

/// Returns whether the mapping of this PDO is empty.
fn maps_nothing(description: &Description, communication: u16) -> bool {
    let count = start_number(description, Address::new(communication + 0x200, 0));
    count.is_none_or(|count| count.value == 0)
}
