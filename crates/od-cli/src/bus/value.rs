//! A value of a node, as lines and as JSON.

use od_eds::outline::meaning_of_bytes;
use od_model::{Address, DataType, Dictionary, Entry, Kind, Visible, values};
use od_tools::objects;
use od_wire::{AbortCode, AbortReason};
use serde_json::{Value, json};

/// Reason for a transfer without a value.
pub(crate) enum NoValue {
    /// The SDO abort code.
    Abort(u32),
    /// The node violates the protocol, in words.
    Fault(String),
}

/// A value that was read or written; if its transfer failed, the reason.
pub(crate) struct Shown {
    pub(crate) address: Address,
    place: String,
    name: String,
    /// The value in words, and the meaning of its number in the documents of CiA.
    words: String,
    meaning: Option<String>,
    pub(crate) result: Result<(DataType, Vec<u8>), NoValue>,
}

impl Shown {
    pub(crate) fn new(
        dictionary: Option<Dictionary<'_>>,
        (address, entry): (Address, Option<&Entry>),
        result: Result<Vec<u8>, NoValue>,
    ) -> Self {
        let typed = |bytes: Vec<u8>| {
            let data_type = entry.map(|entry| entry.data_type);
            (
                data_type.unwrap_or_else(|| objects::type_of(address, &bytes)),
                bytes,
            )
        };
        let result = result.map(typed);
        let (words, meaning) = match &result {
            Ok((data_type, bytes)) => (
                words(dictionary, address, *data_type, bytes),
                meaning(dictionary, address, *data_type, bytes),
            ),
            Err(_) => (String::new(), None),
        };
        Self {
            address,
            place: objects::place(dictionary, address),
            name: objects::name(dictionary, entry),
            words,
            meaning,
            result,
        }
    }

    /// Returns whether the object has no value at the moment, such as an empty error history.
    pub(crate) fn has_no_data(&self) -> bool {
        matches!(self.result, Err(NoValue::Abort(code)) if code == AbortCode::NoData.code())
    }

    /// The value in words, or the abort.
    pub(crate) fn text(&self) -> String {
        match &self.result {
            Ok(_) => self.words.clone(),
            Err(_) if self.has_no_data() => "no data".into(),
            Err(NoValue::Abort(code)) => abort(*code),
            Err(NoValue::Fault(why)) => Visible(why).to_string(),
        }
    }

    fn json(&self) -> Value {
        let mut value = json!({
            "object": self.place,
            "index": self.address.index,
            "sub": self.address.sub,
        });
        if !self.name.is_empty() {
            value["name"] = json!(self.name);
        }
        match &self.result {
            Ok((data_type, bytes)) => {
                value["type"] = json!(data_type.name());
                value["value"] = plain(*data_type, bytes);
                value["bytes"] = json!(values::hex(bytes));
                if let Some(meaning) = &self.meaning {
                    value["meaning"] = json!(meaning);
                }
            }
            Err(NoValue::Fault(why)) => value["error"] = json!(why),
            Err(NoValue::Abort(code)) => {
                value["abort"] = json!(format!("{code:08X}h"));
                value["message"] = json!(self.text());
            }
        }
        value
    }
}

/// A value in words, with the meaning of its number in the documents of CiA: `1: profile position`.
pub(crate) fn words(
    dictionary: Option<Dictionary<'_>>,
    address: Address,
    data_type: DataType,
    bytes: &[u8],
) -> String {
    if bytes.is_empty() {
        return "empty".into();
    }
    let shown = values::show(data_type, bytes);
    match meaning(dictionary, address, data_type, bytes) {
        Some(meaning) => format!("{shown}: {meaning}"),
        None => shown,
    }
}

fn meaning(
    dictionary: Option<Dictionary<'_>>,
    address: Address,
    data_type: DataType,
    bytes: &[u8],
) -> Option<String> {
    meaning_of_bytes(dictionary?, address, data_type, bytes)
}

/// A value in JSON: a number, a boolean or a text; bytes in hexadecimal digits.
pub(crate) fn plain(data_type: DataType, bytes: &[u8]) -> Value {
    if data_type.size().is_some_and(|size| size != bytes.len()) {
        return json!(values::hex(bytes));
    }
    let mut wide = [0; 8];
    let size = bytes.len().min(8);
    wide[..size].copy_from_slice(&bytes[..size]);
    let unused = 64 - 8 * size.max(1) as u32;
    match data_type.kind() {
        Kind::Boolean => json!(bytes != [0]),
        Kind::Unsigned => json!(u64::from_le_bytes(wide)),
        Kind::Signed => json!(i64::from_le_bytes(wide) << unused >> unused),
        Kind::Real => match *bytes {
            [a, b, c, d] => json!(f32::from_le_bytes([a, b, c, d])),
            _ => json!(f64::from_le_bytes(wide)),
        },
        Kind::Text => json!(String::from_utf8_lossy(bytes)),
        Kind::Bytes | Kind::Record => json!(values::hex(bytes)),
    }
}

/// An SDO abort code in words.
pub(crate) fn abort(code: u32) -> String {
    format!("SDO abort {}", AbortReason(code))
}

/// A table of values: place, name, value.
pub(crate) fn lines(values: &[Shown]) -> String {
    let width = |text: fn(&Shown) -> &str| {
        let widths = values.iter().map(|value| text(value).chars().count());
        widths.max().unwrap_or(0)
    };
    let (place, name) = (width(|value| &value.place), width(|value| &value.name));
    let line = |value: &Shown| {
        let text = value.text();
        match name {
            0 => format!("{:<place$}  {text}", value.place),
            _ => format!("{:<place$}  {:<name$}  {text}", value.place, value.name),
        }
    };
    values.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The report of a node's values.
pub(crate) fn json(node: u8, values: &[Shown]) -> String {
    let values: Vec<Value> = values.iter().map(Shown::json).collect();
    format!("{:#}", json!({ "node": node, "values": values }))
}
