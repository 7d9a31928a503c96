//! A dictionary as JSON: for tools that want tables and no parser.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use od_model::{Dictionary, Entry, Group, Literal};
use serde_json::{Value, json};

/// Returns one JSON object: `objects` by index, each with its `entries`. `source` is named in it.
pub fn write(dictionary: Dictionary<'_>, source: &str) -> Value {
    let objects: Vec<Value> = dictionary
        .objects()
        .map(|object| {
            let members = dictionary.members(&object);
            json!({
                "index": format!("0x{:04X}", object.index),
                "name": dictionary.text(object.name),
                "type": object.code.name(),
                "entries": members.map(|entry| one(dictionary, &entry)).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({ "format": "odkit-dictionary/1", "source": source, "objects": objects })
}

fn one(dictionary: Dictionary<'_>, entry: &Entry) -> Value {
    let group = match entry.group {
        Group::None => Value::Null,
        Group::Communication => "communication".into(),
        Group::Application => "application".into(),
        Group::Manufacturer => "manufacturer".into(),
    };
    json!({
        "sub": entry.address.sub,
        "name": dictionary.text(entry.name),
        "dataType": entry.data_type.name(),
        "bits": entry.data_type.bits(),
        "access": entry.access.name(),
        "tpdo": entry.maps_to_tpdo(),
        "rpdo": entry.maps_to_rpdo(),
        "default": value(dictionary, entry.default),
        "low": value(dictionary, entry.low),
        "high": value(dictionary, entry.high),
        "storage": group,
    })
}

/// Numbers as numbers where every JSON reader keeps them exact, else as text.
fn value(dictionary: Dictionary<'_>, literal: Literal) -> Value {
    const EXACT: u64 = 1 << 53;
    match literal {
        Literal::None => Value::Null,
        Literal::Unsigned(number) if number <= EXACT => number.into(),
        Literal::Unsigned(number) => number.to_string().into(),
        Literal::Signed(number) if number.unsigned_abs() <= EXACT => number.into(),
        Literal::Signed(number) => number.to_string().into(),
        Literal::Real(number) if number.is_finite() => number.into(),
        Literal::Real(number) => number.to_string().into(),
        Literal::NodeId(offset) => json!({ "nodeIdPlus": offset }),
        Literal::Text(range) => dictionary.text(range).into(),
        Literal::Bytes(range) => {
            let bytes = dictionary.blob(range).iter();
            let hex: String = bytes.map(|byte| format!("{byte:02X}")).collect();
            json!({ "hex": hex })
        }
    }
}
