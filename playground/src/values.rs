//! Values and dictionary rows as plain records.

use od_bench::pdos;
use od_model::typed::Scalar;
use od_model::{DataType, Dictionary, Entry, Kind, Literal};
use wasm_bindgen::JsValue;

use crate::record::{Record, bytes, integer};

/// A stored value by its type; anything of an unexpected length as bytes.
pub(crate) fn value(data_type: DataType, raw: &[u8]) -> JsValue {
    if data_type.size().is_some_and(|size| size != raw.len()) {
        return bytes(raw);
    }
    match data_type.kind() {
        Kind::Boolean => JsValue::from_bool(raw != [0]),
        Kind::Unsigned => integer(u64::from_wire(raw).into()),
        Kind::Signed => integer(i64::from_wire(raw).into()),
        Kind::Real => match *raw {
            [a, b, c, d] => JsValue::from_f64(f32::from_le_bytes([a, b, c, d]).into()),
            _ => JsValue::from_f64(f64::from_bits(u64::from_wire(raw))),
        },
        Kind::Text => JsValue::from_str(&String::from_utf8_lossy(raw)),
        Kind::Bytes | Kind::Record => bytes(raw),
    }
}

/// A default or a limit, for a node with this ID.
fn literal(dictionary: Dictionary<'_>, entry: &Entry, literal: Literal, node_id: u8) -> JsValue {
    match literal {
        Literal::None => JsValue::NULL,
        Literal::Real(value) => JsValue::from_f64(value),
        Literal::Text(range) => JsValue::from_str(dictionary.text(range)),
        Literal::Bytes(range) => bytes(dictionary.blob(range)),
        _ if entry.data_type.kind() == Kind::Boolean => {
            JsValue::from_bool(literal.integer(node_id) != Some(0))
        }
        _ => literal.integer(node_id).map_or(JsValue::NULL, integer),
    }
}

/// Every entry of a dictionary, in order.
pub(crate) fn dictionary(dictionary: Dictionary<'_>, node_id: u8) -> Vec<JsValue> {
    let mut rows = Vec::with_capacity(dictionary.entries().len());
    for object in dictionary.objects() {
        let parent = if object.code.has_members() {
            JsValue::from_str(dictionary.text(object.name))
        } else {
            JsValue::NULL
        };
        let mapping = pdos::of_mapping(object.index).is_some();
        for entry in dictionary.members(&object) {
            let (tpdo, rpdo) = pdos::fits(&entry);
            let number = |value| literal(dictionary, &entry, value, node_id);
            let row = Record::new()
                .with("index", entry.address.index)
                .with("sub", entry.address.sub)
                .with("name", dictionary.text(entry.name))
                .with("parent", parent.clone())
                .with("type", entry.data_type.name())
                .with("bits", entry.data_type.bits().unwrap_or(0))
                .with("access", entry.access.name())
                .with("mappable", entry.mappable)
                .with("fitsTpdo", tpdo)
                .with("fitsRpdo", rpdo)
                .with("isMapping", mapping)
                .with("isSaved", od_bench::is_saved(&entry))
                .with("default", number(entry.default))
                .with("low", number(entry.low))
                .with("high", number(entry.high));
            rows.push(row.done());
        }
    }
    rows
}
