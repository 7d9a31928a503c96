//! A device on one page, made of what it is compiled from.
//!
//! [`rows`] is the object table alone, for any dictionary; [`page`] is a built-in device's
//! datasheet in Markdown. The texts are ours; the facts come from the dictionary and the
//! profiles, so a page cannot say what the device does not do.

mod encoder;
mod notes;
mod services;
mod table;

use std::format;
use std::prelude::v1::*;

use odkit::{Dictionary, Literal};

use odkit::DeviceKind;
pub use table::{Cells, HEAD, literal, rows};

/// The datasheet of a built-in device, in Markdown.
///
/// Links lead from `docs/datasheets` to the scripts of its family.
pub fn page(kind: &DeviceKind) -> String {
    let mut page = format!(
        "# {}\n\n{}. A virtual device of odkit: `odkit sim {}`, `odkit export {}`.\n\
         Shown by [scripts](../../tests/conformance/{}) of its family.\n\n\
         This page is generated: `odkit dump {} --format md`.\n",
        kind.name, kind.title, kind.name, kind.name, kind.family, kind.name
    );
    section(&mut page, "Identity", &["", ""], &identity(kind.dictionary));
    section(&mut page, "Encoder", &["", ""], &encoder::facts(kind));
    section(&mut page, "Services", &["", ""], &services::facts(kind));
    let faults = encoder::faults(kind);
    let head = encoder::fault_head(kind);
    section(&mut page, "What can break", &head, &faults);
    page.push_str("\n## Objects\n\n");
    page.push_str(&objects(kind.dictionary, |address| {
        notes::note(kind, address)
    }));
    page
}

/// The object table of any dictionary, in Markdown.
pub fn objects_page(title: &str, dictionary: Dictionary<'_>) -> String {
    let mut page = format!("# {}\n", escape(title));
    section(&mut page, "Identity", &["", ""], &identity(dictionary));
    page.push_str("\n## Objects\n\n");
    page.push_str(&objects(dictionary, |_| String::new()));
    page
}

fn objects(dictionary: Dictionary<'_>, note: impl Fn(odkit::Address) -> String) -> String {
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

/// What 1000h, 1008h to 100Ah, 1018h and 6507h say.
fn identity(dictionary: Dictionary<'_>) -> Vec<Vec<String>> {
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
        lines.push([format!("{name} ({})", entry.address), value].to_vec());
    }
    lines
}

fn section(page: &mut String, title: &str, head: &[&str], lines: &[Vec<String>]) {
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

/// Two columns of a table of facts.
fn fact(name: &str, value: impl Into<String>) -> Vec<String> {
    [name.to_owned(), value.into()].to_vec()
}

/// A text that Markdown shows as it is.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '*' | '_' | '[' | ']' | '<' | '>' | '`' | '\\' | '|' => {
                escaped.push('\\');
                escaped.push(c);
            }
            '\r' | '\n' => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
