//! Compares two entries at the same address, field by field.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::impact;
use crate::diff::difference::{Difference, Field, Impact};
use od_model::{Dictionary, Entry, Group, Literal};

pub(super) fn compare(
    found: &mut Vec<Difference>,
    sub: Option<u8>,
    (before, old): (Dictionary<'_>, &Entry),
    (after, new): (Dictionary<'_>, &Entry),
) {
    let mut say = |field, a: String, b: String, impact: Impact| {
        if a != b {
            found.push(Difference {
                index: new.address.index,
                sub,
                name: after.text(new.name).into(),
                field,
                before: a,
                after: b,
                impact,
            });
        }
    };
    let name = |dictionary: Dictionary<'_>, entry: &Entry| dictionary.text(entry.name).to_string();
    say(
        Field::Name,
        name(before, old),
        name(after, new),
        Impact::Compatible,
    );
    say(
        Field::DataType,
        old.data_type.name().into(),
        new.data_type.name().into(),
        Impact::Breaking,
    );
    say(
        Field::Access,
        old.access.name().into(),
        new.access.name().into(),
        impact::access(old.access, new.access),
    );
    say(
        Field::Mapping,
        directions(old).into(),
        directions(new).into(),
        impact::mapping(old, new),
    );
    let (low, high) = impact::limits(old, new);
    let default = impact::default(after, new.address);
    for (field, a, b, impact) in [
        (Field::Default, old.default, new.default, default),
        (Field::LowLimit, old.low, new.low, low),
        (Field::HighLimit, old.high, new.high, high),
    ] {
        // A number of another type has other digits but may be the same.
        if !is_same_number(a, b) {
            say(field, show(before, old, a), show(after, new, b), impact);
        }
    }
    say(
        Field::Storage,
        storage(old.group).into(),
        storage(new.group).into(),
        impact::storage(new.group),
    );
}

fn is_same_number(a: Literal, b: Literal) -> bool {
    let is_node_id = |literal| matches!(literal, Literal::NodeId(_));
    is_node_id(a) == is_node_id(b) && a.integer(0).is_some() && a.integer(0) == b.integer(0)
}

const fn directions(entry: &Entry) -> &'static str {
    match (entry.maps_to_tpdo(), entry.maps_to_rpdo()) {
        (true, true) => "TPDO and RPDO",
        (true, false) => "TPDO",
        (false, true) => "RPDO",
        (false, false) => "none",
    }
}

fn storage(group: Group) -> &'static str {
    group.name().unwrap_or("not saved")
}

/// Shows a value as an EDS writes it; empty if it is missing.
fn show(dictionary: Dictionary<'_>, entry: &Entry, literal: Literal) -> String {
    let digits = entry.data_type.size().unwrap_or(1) * 2;
    match literal {
        Literal::None => String::new(),
        Literal::Unsigned(value @ 0..=9) => value.to_string(),
        Literal::Unsigned(value) => format!("0x{value:0digits$X}"),
        Literal::Signed(value) => value.to_string(),
        Literal::Real(value) => value.to_string(),
        Literal::NodeId(0) => "$NODEID".into(),
        Literal::NodeId(offset) => format!("$NODEID+0x{offset:X}"),
        Literal::Text(range) => format!("{:?}", dictionary.text(range)),
        Literal::Bytes(range) => {
            let bytes = dictionary.blob(range).iter();
            bytes
                .map(|byte| format!("{byte:02X}"))
                .collect::<Vec<_>>()
                .join(" ")
        }
    }
}
