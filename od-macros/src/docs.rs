//! The words on every generated item: an IDE's hover is the datasheet.

use od_model::{
    Access, Address, DataType, EntryDescription, Group, Kind, ObjectDescription, Span, Value,
};

/// The page on one value.
pub(crate) fn entry(
    address: Address,
    entry: &EntryDescription,
    data_type: DataType,
    file: &str,
) -> String {
    let mut text = format!("**{}** {}", address_of(address), escape(&entry.name));
    text.push_str(&format!(
        "\n\n{data_type}, `{}`: {}",
        *entry.access,
        access(*entry.access)
    ));
    let value = |v: &Value| show(v, data_type);
    let given = entry.parameter.as_ref().or(entry.default.as_ref());
    match given {
        Some(v) => text.push_str(&format!("\n\nDefault {}", value(v))),
        None => text.push_str("\n\nNo default"),
    }
    match (&entry.low, &entry.high) {
        (Some(low), Some(high)) => {
            text.push_str(&format!(", from {} to {}", value(low), value(high)))
        }
        (Some(low), None) => text.push_str(&format!(", at least {}", value(low))),
        (None, Some(high)) => text.push_str(&format!(", at most {}", value(high))),
        (None, None) => {}
    }
    text.push_str(match *entry.mappable {
        true => ". A PDO can carry it.",
        false => ". Not for PDOs.",
    });
    match entry.group_at(address) {
        Group::None => {}
        Group::Communication => text.push_str(" Saved with 1010h:02."),
        Group::Application => text.push_str(" Saved with 1010h:03."),
        Group::Manufacturer => text.push_str(" Saved with 1010h:04."),
    }
    place(&mut text, entry.span, file);
    text
}

/// The page on a RECORD or an ARRAY.
pub(crate) fn object(index: u16, object: &ObjectDescription, file: &str) -> String {
    let members = object.entries.len();
    let mut text = format!(
        "**{index:04X}h** {}\n\n{}, {members} sub-indices.",
        escape(&object.name),
        *object.code
    );
    place(&mut text, object.span, file);
    text
}

fn address_of(address: Address) -> String {
    match address.sub {
        0 => format!("{:04X}h", address.index),
        _ => address.to_string(),
    }
}

fn place(text: &mut String, span: Span, file: &str) {
    if span.line != 0 && od_model::patch::token_of(span).is_none() {
        text.push_str(&format!("\n\n`{file}:{}`", span.line));
    }
}

fn access(access: Access) -> &'static str {
    match access {
        Access::Ro => "the master reads it, the device changes it",
        Access::Wo => "the master writes it",
        Access::Rw => "the master reads and writes it",
        Access::Rwr => "the master reads and writes it, and gets it by TPDO",
        Access::Rww => "the master reads and writes it, and sends it by RPDO",
        Access::Const => "nobody changes it",
    }
}

/// Numbers as people look them up: decimal, and hex with the type's digits.
fn show(value: &Value, data_type: DataType) -> String {
    let digits = data_type.size().unwrap_or(4) * 2;
    match value {
        Value::Unsigned(v) if data_type.kind() == Kind::Boolean => (*v != 0).to_string(),
        Value::Unsigned(v) if *v < 10 => v.to_string(),
        Value::Unsigned(v) => format!("{v} (0x{v:0digits$X})"),
        Value::Signed(v) => v.to_string(),
        Value::Real(v) => v.to_string(),
        Value::NodeId(0) => "the node ID".to_string(),
        Value::NodeId(offset) => format!("node ID + 0x{offset:X}"),
        Value::Text(text) => format!("`{text:?}`"),
        Value::Bytes(bytes) if bytes.is_empty() => "no bytes".to_string(),
        Value::Bytes(bytes) if bytes.len() <= 16 => {
            let hex: Vec<String> = bytes.iter().map(|b| format!("{b:02X}")).collect();
            hex.join(" ")
        }
        Value::Bytes(bytes) => format!("{} bytes", bytes.len()),
    }
}

/// A name as Markdown that shows the name.
pub(crate) fn escape(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        if matches!(
            c,
            '*' | '_' | '[' | ']' | '<' | '>' | '`' | '\\' | '#' | '|'
        ) {
            text.push('\\');
        }
        text.push(c);
    }
    text
}
