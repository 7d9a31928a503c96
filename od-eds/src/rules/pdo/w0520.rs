use alloc::vec::Vec;
use core::ops::RangeInclusive;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity::Warning};
use crate::rules::pdo::cob_ids::cob_ids;

pub(crate) static RULE: Rule = Rule {
    code: "W0520",
    severity: Warning,
    title: "CAN-ID is reserved for another service",
    why: "A PDO, SYNC, TIME or EMCY message with a CAN-ID of NMT, SDO, error control or LSS disturbs that service in all devices of the network.",
    source: "CiA 301, restricted CAN-IDs",
    says: "CAN-ID {id:03X}h is one of {first:03X}h to {last:03X}h, which CiA 301 reserves for {service}",
    help: "write a CAN-ID that CiA 301 leaves free, such as `0x181` to `0x57F` for PDOs",
    also: &[WITHOUT_NODE_ID],
    check: Check::Device(check),
    ..Rule::NEW
};

/// The help for the COB-ID of the first TPDO without the node ID.
const WITHOUT_NODE_ID: Form = Form {
    help: "write `$NODEID+0x{value:X}`, which gives each node a CAN-ID of its own",
    ..Form::OWN
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for cob_id in cob_ids(description) {
        // 0 is how many files say "not used".
        if cob_id.is_restricted() && !cob_id.is_too_long() && cob_id.identifier != 0 {
            let (range, service) = reserved(cob_id.identifier);
            let finding = cob_id
                .finding(&RULE)
                .fact("id", cob_id.identifier)
                .fact("first", *range.start())
                .fact("last", *range.end())
                .fact("service", service);
            findings.push(match cob_id.identifier {
                0x180 => finding.form(&WITHOUT_NODE_ID).fact("value", cob_id.value),
                _ => finding,
            });
        }
    }
}

/// The range of a restricted CAN-ID (CiA 301, table of restricted CAN-IDs), and its service.
fn reserved(id: u32) -> (RangeInclusive<u32>, &'static str) {
    match id {
        0..=0x07F => (0x000..=0x07F, "NMT and later use"),
        0x101..=0x180 => (0x101..=0x180, "later use"),
        0x581..=0x5FF => (0x581..=0x5FF, "the default SDO (server to client)"),
        0x601..=0x67F => (0x601..=0x67F, "the default SDO (client to server)"),
        0x6E0..=0x6FF => (0x6E0..=0x6FF, "later use"),
        0x701..=0x77F => (0x701..=0x77F, "NMT error control"),
        _ => (0x780..=0x7FF, "LSS and later use"),
    }
}
