//! $NODEID stands where the node ID can be, and the sum fits for every node.
//!
//! Guarantees that a formula that the tables leave out was named. Assumes nothing.
//! Source: CiA 306-1, $NODEID.

use alloc::format;
use alloc::vec::Vec;

use super::{place, text};
use crate::description::{Description, Value};
use crate::finding::Finding;
use crate::rules;
use od_model::Kind;

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (address, entry) in description.entries() {
        let Some(data_type) = entry.data_type.filter(|t| t.kind() != Kind::Record) else {
            continue;
        };
        for (key, value) in [
            ("DefaultValue", &entry.default),
            ("ParameterValue", &entry.parameter),
            ("LowLimit", &entry.low),
            ("HighLimit", &entry.high),
        ] {
            let Some(value) = value else { continue };
            let Value::NodeId(offset) = value.value else {
                continue;
            };
            let span = place(&[value.span, entry.span]);
            let shown = text::shown(value);
            if !data_type.holds_node_id() {
                findings.push(text::no_formula(key, &shown, span, data_type).about(address));
            } else if !value.fits(*data_type) {
                let name = data_type.name();
                let high = data_type.integer_range().map_or(0, |(_, high)| high);
                findings.push(
                    rules::E0418
                        .told(
                            span,
                            format!(
                                "{key} `{shown}` is {} for node 127, which is no {name}",
                                i128::from(offset) + 127
                            ),
                        )
                        .about(address)
                        .with_label(data_type.span, format!("{name} is declared here"))
                        .with_help(format!("write at most `$NODEID+0x{:X}`", high - 127)),
                );
            }
        }
    }
}
