use alloc::format;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::default_sdo;
use crate::subject::Entry;

pub(crate) static W0530: Rule = Rule {
    title: "COB-ID of the default SDO lacks the node ID",
    why: "A tool that trusts the value finds the SDO of no node. Devices add the node ID themselves, and so do most tools.",
    source: "CiA 301, predefined connection set",
    fixability: Fixability::Unsafe,
    says: "COB-ID of the default SDO is a number, the same for each node ID",
    help: "write `$NODEID+0x{base:X}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0530")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some(sdo) = default_sdo(entry).filter(|sdo| sdo.lacks_node_id) {
        let fix = Fix::unsafe_fix().replace(sdo.span, format!("$NODEID+0x{:X}", sdo.base));
        findings.push(W0530.on(entry, sdo.span).fact("base", sdo.base).fix(fix));
    }
}
