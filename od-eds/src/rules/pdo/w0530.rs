use alloc::format;
use alloc::vec::Vec;

use crate::description::Value;
use crate::finding::{Check, Finding, Fixability, Rule, Severity::Warning};
use crate::fix::Fix;
use crate::subject::{Entry, start_value};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W0530",
    severity: Warning,
    title: "COB-ID of the default SDO is not standard",
    why: "A master sends requests to the default SDO with CAN-ID 600h + node ID and expects responses with 580h + node ID.",
    source: "CiA 301, predefined connection set",
    fixability: Fixability::Unsafe,
    says: "COB-ID of the default SDO must be {base:X}h + node ID",
    help: "write `$NODEID+0x{base:X}`{fix}",
    check: Check::Entry(check),
    ..Rule::NEW
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let base = match entry.address {
        Address {
            index: 0x1200,
            sub: 1,
        } => 0x600,
        Address {
            index: 0x1200,
            sub: 2,
        } => 0x580,
        _ => return,
    };
    let Some(value) = start_value(entry.entry) else {
        return;
    };
    let right = match value.value {
        Value::NodeId(offset) => offset == base,
        Value::Unsigned(number) => {
            let id = entry.description.commissioned_node_id();
            id.is_some_and(|id| number == u64::from(base) + u64::from(id))
        }
        _ => true,
    };
    if !right {
        let fix = Fix::unsafe_fix().replace(value.span, format!("$NODEID+0x{base:X}"));
        findings.push(RULE.on(entry, value.span).fact("base", base).fix(fix));
    }
}
