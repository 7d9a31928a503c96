use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::rules::pdo::cob_ids::cob_ids;

pub(crate) static RULE: Rule = Rule {
    code: "W0520",
    severity: Warning,
    title: "CAN-ID is reserved for another service",
    why: "A PDO, SYNC, TIME or EMCY message with a CAN-ID of NMT, SDO, error control or LSS disturbs that service in all devices of the network.",
    source: "CiA 301, restricted CAN-IDs",
    says: "CAN-ID {id:03X}h is reserved for another service",
    help: "write a CAN-ID that CiA 301 leaves free, such as `0x181` to `0x57F` for PDOs",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for cob_id in cob_ids(description) {
        // 0 is how many files say "not used".
        if cob_id.is_restricted() && !cob_id.is_too_long() && cob_id.identifier != 0 {
            findings.push(cob_id.finding(&RULE).fact("id", cob_id.identifier));
        }
    }
}
