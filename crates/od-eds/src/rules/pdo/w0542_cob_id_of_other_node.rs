use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::cob_ids::cob_ids;

pub(crate) static W0542: Rule = Rule {
    title: "COB-ID formula gives the CAN-ID of another node",
    why: "The default CAN-ID of a service is the node ID plus a multiple of 80h. With a small number more, each node has the CAN-ID of a node with a higher node ID.",
    source: "CiA 301, predefined connection set",
    fixability: Fixability::Unsafe,
    says: "with node ID 1, the CAN-ID is {id:03X}h, which is the default of node {other}",
    help: "write `$NODEID+0x{base:X}`{fix}",
    check: Check::Device(check),
    ..Rule::of("W0542")
};

/// The largest number that is probably added by mistake. A device with more PDOs may have CAN-IDs in the middle of a range.
const MOST: u32 = 15;

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for cob_id in cob_ids(description) {
        let more = cob_id.identifier & 0x7F;
        let is_default = cob_id.predefined().is_some() && cob_id.formula && !cob_id.extended;
        if !is_default || !(1..=MOST).contains(&more) {
            continue;
        }
        let base = cob_id.value - more;
        let finding = cob_id.finding(&W0542).fact("base", base);
        let finding = finding.fact("id", cob_id.can_id(1)).fact("other", more + 1);
        let fix = Fix::unsafe_fix().replace(cob_id.span, alloc::format!("$NODEID+0x{base:X}"));
        findings.push(finding.fix(fix));
    }
}
