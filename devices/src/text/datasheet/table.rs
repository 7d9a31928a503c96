//! The object table: one row for each object with members, and one for each value.

use std::format;
use std::prelude::v1::*;

use odkit::{Address, Dictionary, Entry, Group, Kind, Literal};

use od_model::values;

/// The columns.
pub const HEAD: [&str; 9] = [
    "Index", "Sub", "Name", "Type", "Access", "PDO", "Default", "Limits", "Store",
];

/// One row.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cells {
    /// Where the value is; `None` for the head of an object with members.
    pub address: Option<Address>,
    /// By [`HEAD`]. Names of members are indented by two blanks.
    pub cells: [String; 9],
}

/// The rows of a dictionary, by address.
pub fn rows(dictionary: Dictionary<'_>) -> Vec<Cells> {
    let mut rows = Vec::new();
    for object in dictionary.objects() {
        let has_members = object.code.has_members();
        if has_members {
            let mut cells = [const { String::new() }; 9];
            cells[0] = format!("{:04X}h", object.index);
            cells[2] = dictionary.text(object.name).to_owned();
            cells[3] = object.code.name().to_owned();
            rows.push(Cells {
                address: None,
                cells,
            });
        }
        for entry in dictionary.members(object) {
            rows.push(row(dictionary, entry, has_members));
        }
    }
    rows
}

fn row(dictionary: Dictionary<'_>, entry: &Entry, member: bool) -> Cells {
    let show = |value| literal(dictionary, entry, value);
    let limits = match (show(entry.low), show(entry.high)) {
        (low, high) if low.is_empty() && high.is_empty() => String::new(),
        (low, high) => format!("{low}..{high}"),
    };
    let pdo = match (entry.maps_to_tpdo(), entry.maps_to_rpdo()) {
        (true, true) => "T R",
        (true, false) => "T",
        (false, true) => "R",
        (false, false) => "",
    };
    let group = match entry.group {
        Group::None => "",
        Group::Communication => "comm",
        Group::Application => "app",
        Group::Manufacturer => "manu",
    };
    let address = entry.address;
    let (index, indent) = match member {
        true => (String::new(), "  "),
        false => (format!("{:04X}h", address.index), ""),
    };
    Cells {
        address: Some(address),
        cells: [
            index,
            format!("{:02X}", address.sub),
            format!("{indent}{}", dictionary.text(entry.name)),
            entry.data_type.name().to_owned(),
            entry.access.name().to_owned(),
            pdo.to_owned(),
            show(entry.default),
            limits,
            group.to_owned(),
        ],
    }
}

/// A value in a cell: decimal where the number is small, hex where it is a code, as the
/// manuals write them.
pub fn literal(dictionary: Dictionary<'_>, entry: &Entry, value: Literal) -> String {
    match value {
        Literal::None => String::new(),
        Literal::Unsigned(value) if entry.data_type.kind() == Kind::Boolean => {
            (value != 0).to_string()
        }
        Literal::Unsigned(value @ 0..=9) => value.to_string(),
        Literal::Unsigned(value) => format!("{value:X}h"),
        Literal::Signed(value) => value.to_string(),
        Literal::Real(value) => value.to_string(),
        Literal::NodeId(0) => "node ID".into(),
        Literal::NodeId(offset) => format!("{offset:X}h+node ID"),
        Literal::Text(range) => format!("{:?}", dictionary.text(range)),
        Literal::Bytes(range) => values::hex(dictionary.blob(range)),
    }
}
