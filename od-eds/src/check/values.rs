//! Defaults, configured values and limits are values of their types.
//!
//! Guarantees that what does not fit was named; the tables leave it out.
//! Assumes that formulas with $NODEID are checked elsewhere.
//! Source: CiA 306-1, object sections; CiA 301, data types.

use alloc::vec::Vec;

use super::{place, text};
use crate::description::{Description, Value};
use crate::finding::Finding;
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
            if matches!(value.value, Value::NodeId(_)) || value.fits(*data_type) {
                continue;
            }
            let span = place(&[value.span, entry.span]);
            findings.push(text::no_value(key, &text::shown(value), span, data_type).about(address));
        }
    }
}
