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
    title: "first SDO server is not at its place",
    why: "Every master asks the first SDO server with 600h plus the node ID, and waits for 580h plus the node ID.",
    source: "CiA 301, predefined connection set",
    fixability: Fixability::Unsafe,
    says: "the first SDO server has {base:X}h plus the node ID here",
    help: "write `$NODEID+0x{base:X}`",
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
