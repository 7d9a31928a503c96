//! The description of an object, from the values that the node has.

use std::collections::{BTreeMap, BTreeSet};

use od_eds::outline::specified;
use od_eds::{EntryDescription, ObjectDescription, Spanned, Value};
use od_model::{Access, Address, DataType, Kind, ObjectCode};
use od_wire::NodeId;

use super::probe::FoundObject;
use super::types::{From, Guess};

/// Returns whether the object is a VAR.
pub(super) fn is_whole(found: &[FoundObject]) -> bool {
    found.len() == 1 && found[0].address.sub == 0
}

/// The object with its values and their types.
pub(super) fn describe(
    found: &[FoundObject],
    guesses: &[Guess],
    node: NodeId,
) -> ObjectDescription {
    let index = found[0].address.index;
    let is_whole = is_whole(found);
    let mut entries = BTreeMap::new();
    let mut types = BTreeSet::new();
    let standard = specified(index).map(|known| known.access);
    for (one, guess) in found.iter().zip(guesses) {
        let sub = one.address.sub;
        let data_type = guess.data_type;
        if sub > 0 {
            types.insert(data_type);
        }
        let name = match (is_whole, sub) {
            (true, _) => name(index),
            (false, 0) if index == 0x1003 => "Number of errors".into(),
            (false, 0) => "Highest sub-index supported".into(),
            _ => member(index, sub).unwrap_or_else(|| format!("{} {sub}", name(index))),
        };
        let mut entry = EntryDescription::new(name, data_type);
        let access = match one.writable {
            _ if one.is_write_only => Access::Wo,
            Some(true) => Access::Rw,
            None if standard.is_some_and(Access::writable) => Access::Rw,
            Some(false) if sub == 0 && !is_whole => Access::Const,
            _ => Access::Ro,
        };
        entry.access = Spanned::from(access);
        entry.default = one
            .bytes
            .as_deref()
            .and_then(|bytes| default(one.address, data_type, bytes, node))
            .map(Spanned::from);
        let mut unknown = Vec::new();
        match guess.from {
            From::Length => unknown.push("type by size"),
            From::Value => unknown.push("type by value"),
            From::Standard => {}
        }
        if one.writable.is_none() {
            unknown.push("access");
        }
        if access.writable() && !one.is_write_only {
            unknown.push("limits");
        }
        if !unknown.is_empty() {
            let text = format!("unknown: {}", unknown.join(", "));
            entry.extra.push((";Learned".into(), text));
        }
        entries.insert(sub, entry);
    }
    let code = match (is_whole, specified(index)) {
        (true, _) => ObjectCode::Var,
        (false, Some(known)) if known.code.has_members() => known.code,
        (false, _) if types.len() == 1 => ObjectCode::Array,
        _ => ObjectCode::Record,
    };
    ObjectDescription {
        code: Spanned::from(code),
        name: Spanned::from(name(index)),
        sub_number: (!is_whole).then(|| Spanned::from(entries.len() as u32)),
        entries,
        flags: 0,
        extra: Vec::new(),
        span: Default::default(),
    }
}

/// Sets the access that a write showed, and removes the value from the unknown ones.
pub(super) fn set_access(entry: &mut EntryDescription, writable: bool) {
    entry.access = Spanned::from(if writable { Access::Rw } else { Access::Ro });
    for (_, text) in entry.extra.iter_mut().filter(|(key, _)| key == ";Learned") {
        let known = text.replace(", access", "").replace("access, ", "");
        *text = match (known.as_str(), writable) {
            ("unknown: access", true) => "unknown: limits".into(),
            (_, true) => format!("{known}, limits"),
            _ => known,
        };
    }
    let is_left = |(key, text): &(String, String)| key != ";Learned" || text != "unknown: access";
    entry.extra.retain(is_left);
}

/// The name of a sub-object in CiA 301.
fn member(index: u16, sub: u8) -> Option<String> {
    let names: &[&str] = match index {
        0x1010 => &[
            "Save all parameters",
            "Save communication parameters",
            "Save application parameters",
        ],
        0x1011 => &[
            "Restore all default parameters",
            "Restore communication default parameters",
            "Restore application default parameters",
        ],
        0x1018 => &[
            "Vendor-ID",
            "Product code",
            "Revision number",
            "Serial number",
        ],
        0x1029 => &["Communication error"],
        0x1200..=0x12FF => &[
            "COB-ID client -> server",
            "COB-ID server -> client",
            if index < 0x1280 {
                "Node-ID of the SDO client"
            } else {
                "Node-ID of the SDO server"
            },
        ],
        0x1400..=0x15FF | 0x1800..=0x19FF => &[
            "COB-ID",
            "Transmission type",
            "Inhibit time",
            "Reserved",
            "Event timer",
            "SYNC start value",
        ],
        _ => &[],
    };
    match (index, names.get(usize::from(sub).checked_sub(1)?)) {
        (_, Some(name)) => Some((*name).into()),
        (0x1003, None) => Some(format!("Standard error field {sub}")),
        (0x1016, None) => Some(format!("Consumer heartbeat time {sub}")),
        (0x1600..=0x17FF | 0x1A00..=0x1BFF, None) => Some(format!("Mapped object {sub}")),
        _ => None,
    }
}

/// The name of an object in its standard, with a capital as the documents write it.
fn name(index: u16) -> String {
    match specified(index) {
        Some(known) => {
            let mut name = String::from(known.name);
            if let Some(first) = name.get_mut(..1) {
                first.make_ascii_uppercase();
            }
            name
        }
        None => format!("Object {index:04X}h"),
    }
}

/// The value as a default value; a COB-ID of the predefined connection set becomes `$NODEID+…`.
fn default(address: Address, data_type: DataType, bytes: &[u8], node: NodeId) -> Option<Value> {
    let mut wide = [0; 8];
    match data_type.kind() {
        Kind::Text => return Some(Value::Text(String::from_utf8_lossy(bytes).into_owned())),
        Kind::Bytes => return Some(Value::Bytes(bytes.to_vec())),
        Kind::Real if bytes.len() == 4 => {
            let bits = [bytes[0], bytes[1], bytes[2], bytes[3]];
            // The shortest text of a REAL32: 12.345, not 12.345000267028809.
            let text = f32::from_le_bytes(bits).to_string();
            return text.parse().ok().map(Value::Real);
        }
        _ => wide.get_mut(..bytes.len())?.copy_from_slice(bytes),
    }
    let raw = u64::from_le_bytes(wide);
    if data_type.kind() == Kind::Real {
        return Some(Value::Real(f64::from_bits(raw)));
    }
    if let Some((low, _)) = data_type.integer_range()
        && low < 0
    {
        let unused = 64 - 8 * bytes.len() as u32;
        return Some(Value::Signed((raw as i64) << unused >> unused));
    }
    let is_cob_id = match address.index {
        0x1014 => true,
        0x1200 => matches!(address.sub, 1 | 2),
        0x1400..=0x15FF | 0x1800..=0x19FF => address.sub == 1,
        _ => false,
    };
    let node = u64::from(node.raw());
    if is_cob_id && raw & 0x7F == node && raw & 0x780 != 0 {
        u32::try_from(raw - node).ok().map(Value::NodeId)
    } else {
        Some(Value::Unsigned(raw))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_real32_has_its_shortest_text() {
        let bytes = 12.345_f32.to_le_bytes();
        let value = default(
            Address::new(0x2000, 0),
            DataType::Real32,
            &bytes,
            NodeId::ONE,
        );
        assert_eq!(value, Some(Value::Real(12.345)));
    }
}
