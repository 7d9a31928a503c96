//! CAN identifiers are free for what they are used for, and used once.
//!
//! Guarantees that a network of such devices starts without two of them meeting on one
//! identifier. Assumes that values which do not fit were named.
//! Source: CiA 301, restricted CAN-IDs and predefined connection set.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::vec::Vec;

use super::{place, start_value};
use crate::description::{Description, Value};
use crate::finding::Finding;
use crate::rules;
use crate::span::Span;
use od_model::Address;

/// The bit of a COB-ID that says "not valid"; of 1005h and 1012h it says "producer".
const INVALID: u32 = 1 << 31;
/// The bit that says 29-bit identifier.
const EXTENDED: u32 = 1 << 29;

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    let mut used: BTreeMap<(bool, u32), (Address, Span)> = BTreeMap::new();
    let services = [0x1005, 0x1012, 0x1014].map(|index| Address::new(index, 0));
    let pdos = description
        .objects
        .range(0x1400..=0x19FF)
        .filter(|(index, _)| matches!(index, 0x1400..=0x15FF | 0x1800..=0x19FF))
        .map(|(index, _)| Address::new(*index, 1));
    for address in services.into_iter().chain(pdos) {
        let Some(entry) = description.entry(address) else {
            continue;
        };
        let Some(value) = start_value(entry) else {
            continue;
        };
        let span = place(&[value.span, entry.span]);
        let pdo = address.sub == 1;
        let (number, formula) = match &value.value {
            Value::Unsigned(number) => match u32::try_from(*number) {
                Ok(number) => (number, false),
                Err(_) => continue,
            },
            Value::NodeId(offset) => (*offset, true),
            _ => continue,
        };
        if number & INVALID != 0 && address.index != 0x1005 && address.index != 0x1012 {
            continue;
        }
        let identifier = number & 0x1FFF_FFFF;
        if number & EXTENDED == 0 && identifier > 0x7FF {
            findings.push(
                rules::W0522
                    .told(
                        span,
                        format!("0x{identifier:X} has more than 11 bits, and bit 29 is 0"),
                    )
                    .about(address)
                    .with_help("write an identifier up to 0x7FF, or set bit 29 (0x20000000)"),
            );
            continue;
        }
        if number & EXTENDED == 0 && !formula && restricted(identifier) {
            // 0 is how many files say "not used".
            if identifier != 0 {
                findings.push(
                    rules::W0520
                        .told(span, format!("{identifier:03X}h is an identifier of another service"))
                        .about(address)
                        .with_help("write an identifier that CiA 301 leaves free, such as 0x181 to 0x57F for PDOs"),
                );
            }
            continue;
        }
        if !pdo {
            continue;
        }
        match used.get(&(formula, identifier)) {
            None => drop(used.insert((formula, identifier), (address, span))),
            Some((first, place)) => findings.push(
                rules::W0521
                    .told(span, format!("{:04X}h has the COB-ID of {:04X}h", address.index, first.index))
                    .about(address)
                    .with_label(*place, "it is used here")
                    .with_help("write another COB-ID, or set bit 31 (0x80000000) for a PDO that is not used"),
            ),
        }
        let fixed = description.commissioned_node_id().is_none() && entry.parameter.is_none();
        let predefined = matches!(identifier, 0x181..=0x57F) && number & EXTENDED == 0;
        let first_four = matches!(address.index, 0x1400..=0x1403 | 0x1800..=0x1803);
        if !formula && fixed && predefined && first_four {
            findings.push(
                rules::I0531
                    .told(
                        span,
                        format!("{identifier:03X}h does not follow the node ID"),
                    )
                    .about(address)
                    .with_help(format!(
                        "write `$NODEID+0x{:X}`, if every device has its own",
                        identifier & 0x780
                    )),
            );
        }
    }
}

/// Identifiers that CiA 301 keeps for its services: NMT, SDO, error control, LSS and others.
fn restricted(identifier: u32) -> bool {
    matches!(
        identifier,
        0 | 0x001..=0x07F | 0x101..=0x180 | 0x581..=0x5FF | 0x601..=0x67F | 0x6E0..=0x6FF | 0x701..=0x77F | 0x780..=0x7FF
    )
}

#[cfg(test)]
mod tests {
    use super::restricted;

    #[test]
    fn what_cia_301_keeps() {
        for free in [
            0x080, 0x100, 0x181, 0x57F, 0x580, 0x600, 0x680, 0x6DF, 0x700,
        ] {
            assert!(!restricted(free), "{free:X}");
        }
        for kept in [
            0x000, 0x001, 0x101, 0x180, 0x581, 0x601, 0x6E0, 0x701, 0x7E5,
        ] {
            assert!(restricted(kept), "{kept:X}");
        }
    }
}
