//! Values and dictionary rows as plain records.

use od_model::typed::Scalar;
use od_model::{DataType, Dictionary, Entry, Kind, Literal};
use od_sim::pdos;
use wasm_bindgen::JsValue;

use crate::crossing::{Crosses, Made, declaration, names, record};
use crate::record::{bytes, integer};

/// A value of an object.
pub(crate) struct Value(JsValue);

impl Crosses for Value {
    const TYPE: &'static str = "Value";

    fn value(self) -> JsValue {
        self.0
    }
}

declaration!(
    "/** A value: 64-bit integers that a number cannot hold come as bigint. */\n",
    "export type Value = number | bigint | string | boolean | Uint8Array | null;\n",
);

names! {
    Access: od_model::Access { Ro, Wo, Rw, Rwr, Rww, Const, }
}

record! {
    /// A row of the object dictionary: one value.
    ObjectRecord {
        index: u16,
        sub: u8,
        /// The name of the object, or of the sub-object of a record or array.
        name: Made<String>,
        /// The name of the record or array, for its sub-objects.
        parent: Made<Option<String>>,
        /// `UNSIGNED32`, `VISIBLE_STRING`, as in CiA 301.
        "type" data_type: &'static str,
        /// Length in bits; 0 if it varies.
        bits: u16,
        access: od_model::Access,
        /// Whether it may be mapped into a PDO.
        mappable: bool,
        /// Whether it may be mapped into a TPDO, by access and length.
        "fitsTpdo" fits_tpdo: bool,
        /// Whether it may be mapped into an RPDO, by access and length.
        "fitsRpdo" fits_rpdo: bool,
        /// Whether it belongs to a PDO mapping parameter.
        "isMapping" is_mapping: bool,
        /// Whether 1010h saves it.
        "isSaved" is_saved: bool,
        default: Value,
        low: Value,
        high: Value,
    }
}

/// A stored value by its type; a value of an unexpected length as bytes.
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

/// Every value of a dictionary, in order.
pub(crate) fn dictionary(dictionary: Dictionary<'_>, node_id: u8) -> Vec<JsValue> {
    let mut rows = Vec::with_capacity(dictionary.entries().len());
    for object in dictionary.objects() {
        let parent = Made::of(if object.code.has_members() {
            JsValue::from_str(dictionary.text(object.name))
        } else {
            JsValue::NULL
        });
        let is_mapping = pdos::of_mapping(object.index).is_some();
        for entry in dictionary.members(&object) {
            let (fits_tpdo, fits_rpdo) = pdos::fits(&entry);
            let number = |value| Value(literal(dictionary, &entry, value, node_id));
            let row = ObjectRecord {
                index: entry.address.index,
                sub: entry.address.sub,
                name: Made::of(JsValue::from_str(dictionary.text(entry.name))),
                parent: parent.clone(),
                data_type: entry.data_type.name(),
                bits: entry.data_type.bits().unwrap_or(0).into(),
                access: entry.access,
                mappable: entry.mappable,
                fits_tpdo,
                fits_rpdo,
                is_mapping,
                is_saved: od_sim::is_saved(&entry),
                default: number(entry.default),
                low: number(entry.low),
                high: number(entry.high),
            };
            rows.push(row.value());
        }
    }
    rows
}
