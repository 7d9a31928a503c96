//! The documentation of every generated item, which an IDE shows as hover text.

use od_eds::patch::Action;
use od_eds::{EntryDescription, ObjectDescription, Span, Value};
use od_model::{Access, Address, DataType, Group, Kind};

use crate::files::Files;
use crate::input::Statement;

/// The documentation of a variant: its differences from the base.
pub(crate) fn variant(family: &str, statements: &[Statement]) -> String {
    let mut text = format!("\n\nA variant of `{family}`");
    let mut join = ": ";
    for (wanted, word) in [
        (Action::Add, "added"),
        (Action::Modify, "changed"),
        (Action::Remove, "removed"),
    ] {
        let targets = statements.iter().filter_map(|statement| match statement {
            Statement::Edit { action, target, .. } if *action == wanted => Some(target.target),
            _ => None,
        });
        let targets: Vec<String> = targets.map(|target| format!("`{target}`")).collect();
        if !targets.is_empty() {
            text.push_str(&format!("{join}{word} {}", targets.join(", ")));
            join = "; ";
        }
    }
    text.push('.');
    text
}

/// The documentation of a value: of a VAR, or of a sub-object.
pub(crate) fn entry(
    address: Address,
    is_sub_object: bool,
    entry: &EntryDescription,
    data_type: DataType,
    files: Option<&Files>,
) -> String {
    let name = escape(&entry.name);
    let mut text = if is_sub_object {
        format!("**{address}** {name}")
    } else {
        format!("**{:04X}h** {name}", address.index)
    };
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
    text.push_str(if *entry.mappable {
        ". A PDO can carry it."
    } else {
        ". Not for PDOs."
    });
    match entry.group_at(address) {
        Group::None => {}
        Group::Communication => text.push_str(" Saved with 1010h:02."),
        Group::Application => text.push_str(" Saved with 1010h:03."),
        Group::Manufacturer => text.push_str(" Saved with 1010h:04."),
    }
    place(&mut text, entry.span, files);
    text
}

/// The documentation of a RECORD or an ARRAY.
pub(crate) fn object(index: u16, object: &ObjectDescription, files: Option<&Files>) -> String {
    let members = object.entries.len();
    let mut text = format!(
        "**{index:04X}h** {}\n\n{}, {members} sub-indices.",
        escape(&object.name),
        *object.code
    );
    place(&mut text, object.span, files);
    text
}

fn place(text: &mut String, span: Span, files: Option<&Files>) {
    let written = span.line != 0 && od_eds::token_of(span).is_none();
    if let Some(files) = files.filter(|_| written) {
        text.push_str(&format!("\n\n`{}`", files.line(span)));
    }
}

fn access(access: Access) -> &'static str {
    match access {
        Access::Ro => "the master reads it, the device changes it",
        Access::Wo => "the master writes it",
        Access::Rw => "the master reads and writes it",
        Access::Rwr => "the master reads and writes it, and gets it by TPDO",
        Access::Rww => "the master reads and writes it, and sends it by RPDO",
        Access::Const => "it never changes",
    }
}

/// A number in decimal, and in hexadecimal with the digits of its type.
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

/// A name with Markdown characters escaped.
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

#[cfg(test)]
mod tests {
    use od_eds::Spanned;

    use super::*;

    #[test]
    fn a_page_says_what_the_eds_says() {
        let mut speed = EntryDescription::new("Speed [rpm]", DataType::Unsigned16);
        speed.access = Spanned::from(Access::Rw);
        speed.default = Some(Spanned::from(Value::Unsigned(300)));
        speed.low = Some(Spanned::from(Value::Unsigned(1)));
        speed.high = Some(Spanned::from(Value::Unsigned(0x3FF)));
        speed.span.line = 214;
        let page = entry(
            Address::new(0x2300, 9),
            true,
            &speed,
            DataType::Unsigned16,
            Some(&Files::one("GXMMW.eds")),
        );
        assert_eq!(
            page,
            "**2300h:09** Speed \\[rpm\\]\n\n\
            UNSIGNED16, `rw`: the master reads and writes it\n\n\
            Default 300 (0x012C), from 1 to 1023 (0x03FF). Not for PDOs. \
            Saved with 1010h:04.\n\n\
            `GXMMW.eds:214`"
        );
    }

    #[test]
    fn numbers_are_shown_as_they_are_looked_up() {
        for (value, data_type, shown) in [
            (Value::Unsigned(7), DataType::Unsigned32, "7"),
            (Value::Unsigned(10), DataType::Unsigned8, "10 (0x0A)"),
            (Value::Unsigned(1), DataType::Boolean, "true"),
            (Value::Signed(-3), DataType::Integer8, "-3"),
            (
                Value::NodeId(0x180),
                DataType::Unsigned32,
                "node ID + 0x180",
            ),
            (Value::NodeId(0), DataType::Unsigned8, "the node ID"),
            (
                Value::Text("a\"b".into()),
                DataType::VisibleString,
                "`\"a\\\"b\"`",
            ),
            (Value::Bytes(vec![0, 0xFF]), DataType::OctetString, "00 FF"),
        ] {
            assert_eq!(show(&value, data_type), shown);
        }
    }
}
