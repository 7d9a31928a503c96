use alloc::format;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::pdo::shared::default_sdo;
use crate::subject::Entry;

pub(crate) static E0533: Rule = Rule {
    buildable: true,
    title: "COB-ID of the default SDO is not standard",
    why: "A master sends requests to the default SDO with CAN-ID 600h + node ID and expects responses with 580h + node ID.",
    source: "CiA 301, predefined connection set",
    fixability: Fixability::Unsafe,
    says: "COB-ID of the default SDO must be {base:X}h + node ID",
    help: "write `$NODEID+0x{base:X}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("E0533")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    if let Some(sdo) = default_sdo(entry).filter(|sdo| !sdo.lacks_node_id) {
        let fix = Fix::unsafe_fix().replace(sdo.span, format!("$NODEID+0x{:X}", sdo.base));
        findings.push(E0533.on(entry, sdo.span).fact("base", sdo.base).fix(fix));
    }
}
