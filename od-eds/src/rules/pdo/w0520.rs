use alloc::vec::Vec;
use core::ops::RangeInclusive;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity::Error};
use crate::rules::pdo::cob_ids::{CobId, Service, cob_ids};
use crate::subject::start_number;
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W0520",
    severity: Error,
    buildable: true,
    title: "CAN-ID is reserved for another service",
    why: "A message with a CAN-ID of NMT, SDO, error control or LSS disturbs that service in all devices of the network.",
    source: "CiA 301, restricted CAN-IDs",
    says: "CAN-ID {id} is one of {first:03X}h to {last:03X}h, which CiA 301 reserves for {service}",
    help: "write a CAN-ID that CiA 301 leaves free, such as `0x181` to `0x57F` for PDOs",
    also: &[WITHOUT_NODE_ID, NMT, SERVICE],
    check: Check::Device(check),
    ..Rule::NEW
};

/// Sentence for the CAN-ID of NMT commands.
const NMT: Form = Form {
    says: "CAN-ID 000h is that of NMT",
    help: "write a CAN-ID of the service, or set bit 31 (`0x80000000`) if it is not used",
};

/// The help for another service than PDOs.
const SERVICE: Form = Form {
    help: "write the CAN-ID of the service, such as `0x80` for SYNC, `0x100` for TIME and `$NODEID+0x80` for EMCY",
    ..Form::OWN
};

/// The help for the COB-ID of the first TPDO without the node ID.
const WITHOUT_NODE_ID: Form = Form {
    help: "write `$NODEID+0x{value:X}`, which gives each node a CAN-ID of its own",
    ..Form::OWN
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for cob_id in cob_ids(description) {
        // 0 of a client, a consumer or a PDO that maps nothing says that it is not used.
        let is_idle = match cob_id.service {
            Service::SdoClient | Service::EmcyConsumer => true,
            Service::Pdo => maps_nothing(description, cob_id.entry.address.index),
            _ => false,
        };
        let unused = cob_id.identifier == 0 && !cob_id.formula && is_idle;
        if cob_id.is_restricted() && !cob_id.is_too_long() && !unused {
            findings.push(finding(&cob_id));
        }
    }
}

fn finding(cob_id: &CobId<'_>) -> Finding {
    let finding = cob_id.finding(&RULE);
    if cob_id.identifier == 0 && !cob_id.formula {
        return finding.form(&NMT);
    }
    let (range, service) = reserved(*cob_id.can_ids().start());
    let finding = finding.fact("id", cob_id.shown()).fact("service", service);
    let finding = finding
        .fact("first", *range.start())
        .fact("last", *range.end());
    match cob_id.identifier {
        0x180 if !cob_id.formula => finding.form(&WITHOUT_NODE_ID).fact("value", cob_id.value),
        _ if cob_id.service == Service::Pdo => finding,
        _ => finding.form(&SERVICE),
    }
}

/// Is the mapping of this PDO empty?
fn maps_nothing(description: &Description, communication: u16) -> bool {
    let count = start_number(description, Address::new(communication + 0x200, 0));
    count.is_none_or(|count| count.value == 0)
}

/// The range of a restricted CAN-ID (CiA 301, table of restricted CAN-IDs), and its service.
fn reserved(id: u32) -> (RangeInclusive<u32>, &'static str) {
    match id {
        0..=0x07F => (0x001..=0x07F, "later use"),
        0x101..=0x180 => (0x101..=0x180, "later use"),
        0x581..=0x5FF => (0x581..=0x5FF, "the default SDO (server to client)"),
        0x601..=0x67F => (0x601..=0x67F, "the default SDO (client to server)"),
        0x6E0..=0x6FF => (0x6E0..=0x6FF, "later use"),
        0x701..=0x77F => (0x701..=0x77F, "NMT error control"),
        _ => (0x780..=0x7FF, "LSS and later use"),
    }
}
