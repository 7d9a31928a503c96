use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::cob_ids::cob_ids;

pub(crate) static I0531: Rule = Rule {
    title: "COB-ID does not depend on the node ID",
    why: "Two such devices in one network use the same CAN-ID. The COB-IDs of EMCY and of the first four PDOs usually contain $NODEID.",
    source: "CiA 301, predefined connection set",
    fixability: Fixability::Unsafe,
    says: "COB-ID {id:03X}h does not depend on the node ID",
    help: "write `$NODEID+0x{base:X}` to give each node its own COB-ID{fix}",
    check: Check::Device(check),
    ..Rule::of("I0531")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    for cob_id in cob_ids(description) {
        let id = cob_id.identifier;
        let index = cob_id.entry.address.index;
        let fixed =
            description.commissioned_node_id().is_none() && cob_id.entry.parameter.is_none();
        let predefined = match index {
            0x1014 => matches!(id, 0x81..=0xFF),
            0x1400..=0x1403 | 0x1800..=0x1803 => matches!(id, 0x181..=0x57F),
            _ => false,
        };
        if !cob_id.formula && fixed && predefined && !cob_id.extended {
            let base = id & 0x780;
            let finding = cob_id.finding(&I0531).fact("id", id).fact("base", base);
            // A fix that changes the base could take the CAN-ID of another PDO: only the author can decide that.
            let default = cob_id
                .default()
                .filter(|_| cob_id.predefined() == Some((base, true)));
            findings.push(match default {
                Some(right) => finding.fix(Fix::unsafe_fix().replace(cob_id.span, right)),
                None => finding,
            });
        }
    }
}
