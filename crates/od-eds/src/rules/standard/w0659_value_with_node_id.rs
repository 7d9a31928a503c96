use alloc::vec::Vec;

use crate::description::Value;
use crate::finding::{Check, Finding, Rule};
use crate::rules::pdo::shared::maps_rpdo;
use crate::subject::{Entry, start_value};

pub(crate) static W0659: Rule = Rule {
    title: "value cannot depend on the node ID",
    why: "What a device is, how many sub-indices an object has, and what a PDO contains is the same with every node ID: a master compares 1000h and 1018h with the values of the file, and LSS addresses the device by 1018h before it has a node ID. odkit adds the node ID.",
    source: "CiA 301, chapter 7.5; CiA 305, LSS address",
    says: "{object} is the same with every node ID, but its value has `$NODEID`",
    help: "write the number without `$NODEID`",
    check: Check::Entry(check),
    ..Rule::of("W0659")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let same = match (entry.address.index, entry.address.sub) {
        (0x1000 | 0x1001, 0) | (0x1018, _) => true,
        (_, 0) => entry.object.code.has_members(),
        (0x1400..=0x15FF | 0x1800..=0x19FF, sub) => sub != 1,
        (index, _) => maps_rpdo(index).is_some(),
    };
    if let Some(value) = start_value(entry.entry)
        && matches!(**value, Value::NodeId(_))
        && same
    {
        findings.push(W0659.on(entry, value.span).fact("object", entry.shown()));
    }
}
