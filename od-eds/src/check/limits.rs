//! Limits leave something between them, and the defaults lie there.
//!
//! Guarantees that a device can be set to its own defaults. Assumes that limits
//! and defaults are values of their types; what is not was named and is left out.
//! Source: CiA 306-1, LowLimit and HighLimit.

use alloc::format;
use alloc::vec::Vec;
use core::cmp::Ordering;

use super::{place, text};
use crate::description::{Description, Value};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::span::{Spanned, token_of};
use od_model::DataType;

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    for (address, entry) in description.entries() {
        let Some(data_type) = entry.data_type else {
            continue;
        };
        let low = fitting(&entry.low, *data_type);
        let high = fitting(&entry.high, *data_type);
        if let (Some(low), Some(high)) = (low, high)
            && order(low, high) == Some(Ordering::Greater)
        {
            findings.push(
                rules::E0415
                    .told(
                        place(&[low.span, entry.span]),
                        format!(
                            "LowLimit {} is greater than HighLimit {}",
                            text::shown(low),
                            text::shown(high)
                        ),
                    )
                    .about(address)
                    .with_label(high.span, "HighLimit is here")
                    .with_help("swap the two, or leave both empty")
                    .fix(
                        Fix::unsafe_fix()
                            .replace(low.span, text::shown(high))
                            .replace(high.span, text::shown(low)),
                    ),
            );
            continue;
        }
        for (key, value) in [
            ("DefaultValue", &entry.default),
            ("ParameterValue", &entry.parameter),
        ] {
            let Some(value) = fitting(value, *data_type) else {
                continue;
            };
            for (limit, wrong, side) in [
                (low, Ordering::Less, "below LowLimit"),
                (high, Ordering::Greater, "above HighLimit"),
            ] {
                let Some(limit) = limit else { continue };
                if order(value, limit) != Some(wrong) {
                    continue;
                }
                let (shown, bound) = (text::shown(value), text::shown(limit));
                // A master that configures by a DCF gets an abort; a default is only odd. What
                // stands in a macro call is the author's own to mend.
                let own = |span| token_of(span).is_some();
                let fails = key == "ParameterValue" || own(value.span) || own(limit.span);
                let rule = match fails {
                    true => &rules::E0414,
                    false => &rules::W0452,
                };
                findings.push(
                    rule.told(
                        place(&[value.span, entry.span]),
                        format!("{key} {shown} is {side} {bound}"),
                    )
                    .about(address)
                    .with_label(limit.span, "the limit is here")
                    .with_help(format!(
                        "write a {key} within the limits, or mend the limit"
                    )),
                );
            }
        }
    }
}

fn fitting(value: &Option<Spanned<Value>>, data_type: DataType) -> Option<&Spanned<Value>> {
    value.as_ref().filter(|value| value.fits(data_type))
}

/// How two values compare for every node ID; `None` if that depends on it, or they do not compare.
fn order(a: &Value, b: &Value) -> Option<Ordering> {
    if let (Value::Real(a), Value::Real(b)) = (a, b) {
        return a.partial_cmp(b);
    }
    let at = |id| Some(a.integer(id)?.cmp(&b.integer(id)?));
    let (first, last) = (at(1)?, at(127)?);
    (first == last).then_some(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_compare_for_all_nodes_or_not_at_all() {
        use Value::{NodeId, Unsigned};
        assert_eq!(
            order(&NodeId(0x180), &Unsigned(0x200)),
            Some(Ordering::Less)
        );
        assert_eq!(order(&NodeId(0x180), &Unsigned(0x190)), None);
        assert_eq!(order(&NodeId(0), &NodeId(1)), Some(Ordering::Less));
        assert_eq!(order(&Value::Real(1.0), &Unsigned(0)), None);
    }
}
