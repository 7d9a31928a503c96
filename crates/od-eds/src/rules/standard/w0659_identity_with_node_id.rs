use alloc::vec::Vec;

use crate::description::Value;
use crate::finding::{Check, Finding, Rule};
use crate::subject::{Entry, start_value};

pub(crate) static W0659: Rule = Rule {
    title: "identity of a device depends on its node ID",
    why: "A master compares 1000h and 1018h with the values of the file, and LSS addresses the device by 1018h before it has a node ID. A value that changes with the node ID identifies no device. odkit adds the node ID.",
    source: "CiA 301, objects 1000h and 1018h; CiA 305, LSS address",
    says: "{object} identifies the device, but its value depends on the node ID",
    help: "write the number of the device without `$NODEID`",
    check: Check::Entry(check),
    ..Rule::of("W0659")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let identifies = matches!(
        (entry.address.index, entry.address.sub),
        (0x1000, 0) | (0x1018, 1..=4)
    );
    if let Some(value) = start_value(entry.entry)
        && matches!(**value, Value::NodeId(_))
        && identifies
    {
        findings.push(W0659.on(entry, value.span).fact("object", entry.shown()));
    }
}
