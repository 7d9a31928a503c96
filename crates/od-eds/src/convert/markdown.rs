//! A dictionary as a page in Markdown: identity, and one row for each object and value.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use od_model::{Address, Dictionary, Entry, Group, Kind, Literal, Visible, values};

/// The columns.
pub const HEAD: [&str; 9] = [
    "Index", "Sub", "Name", "Type", "Access", "PDO", "Default", "Limits", "Store",
];

/// One row.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cells {
    /// Address of the value; `None` for the heading of an object with sub-objects.
    pub address: Option<Address>,
    /// The columns of [`HEAD`]. Names of members are indented by two blanks.
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
        for entry in dictionary.members(&object) {
            rows.push(row(dictionary, &entry, has_members));
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
    let (index, indent) = if member {
        (String::new(), "  ")
    } else {
        (format!("{:04X}h", address.index), "")
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

/// A value in a cell: a small number is decimal, a code is hexadecimal, as in the
/// manuals.
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

/// Returns the page of a dictionary: its identity and its object table.
pub fn page(title: &str, dictionary: Dictionary<'_>) -> String {
    let mut page = format!("# {}\n", escape(title));
    section(&mut page, "Identity", &["", ""], &identity(dictionary));
    page.push_str("\n## Objects\n\n");
    page.push_str(&objects(dictionary, |_| String::new()));
    page
}

/// Returns the object table, with a last column of notes.
pub fn objects(dictionary: Dictionary<'_>, note: impl Fn(Address) -> String) -> String {
    let mut head: Vec<&str> = HEAD.to_vec();
    head.push("Notes");
    let body: Vec<Vec<String>> = rows(dictionary)
        .into_iter()
        .map(|row| {
            let mut cells = row.cells.map(|cell| escape(cell.trim())).to_vec();
            cells.push(row.address.map(&note).unwrap_or_default());
            cells
        })
        .collect();
    markdown(&head, &body)
}

/// Returns the facts of 1000h, 1008h to 100Ah, 1018h and 6507h, in two columns.
pub fn identity(dictionary: Dictionary<'_>) -> Vec<Vec<String>> {
    const FACTS: [(&str, u16, u8); 9] = [
        ("Device type", 0x1000, 0),
        ("Device name", 0x1008, 0),
        ("Hardware version", 0x1009, 0),
        ("Software version", 0x100A, 0),
        ("Vendor-ID", 0x1018, 1),
        ("Product code", 0x1018, 2),
        ("Revision number", 0x1018, 3),
        ("Serial number", 0x1018, 4),
        ("Profile and software version", 0x6507, 0),
    ];
    let mut lines = Vec::new();
    for (name, index, sub) in FACTS {
        let Some(entry) = dictionary.entry(index, sub) else {
            continue;
        };
        let value = match entry.default {
            Literal::Text(range) => escape(dictionary.text(range)),
            Literal::Unsigned(number) => format!("{number:08X}h"),
            _ => continue,
        };
        let value = match (index, sub) {
            (0x1018, 4) => format!("{value}, unless another one is given"),
            _ => value,
        };
        lines.push(fact(&format!("{name} ({})", entry.address), value));
    }
    lines
}

/// Adds a section with a table to a page; nothing if there are no lines.
pub fn section(page: &mut String, title: &str, head: &[&str], lines: &[Vec<String>]) {
    if !lines.is_empty() {
        page.push_str(&format!("\n## {title}\n\n"));
        page.push_str(&markdown(head, lines));
    }
}

fn markdown(head: &[&str], lines: &[Vec<String>]) -> String {
    let mut text = format!("| {} |\n|{}\n", head.join(" | "), "---|".repeat(head.len()));
    for line in lines {
        text.push_str(&format!("| {} |\n", line.join(" | ")));
    }
    text
}

/// Returns a line of two columns.
pub fn fact(name: &str, value: impl Into<String>) -> Vec<String> {
    [name.to_owned(), value.into()].to_vec()
}

/// Escapes a text for Markdown.
pub fn escape(text: &str) -> String {
    Visible(text).markdown()
}
