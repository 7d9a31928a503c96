//! The values of keys with a list of values, in the section of an object.

use od_eds::outline::{self, Place};
use od_model::{Access, Address, DataType, Kind, ObjectCode};

use crate::file::Seen;
use crate::layout::Section;
use crate::mentions::{is_mapping, is_value_key};
use crate::{standard, words};

/// A value to choose.
pub(super) struct Choice {
    pub(super) label: String,
    pub(super) detail: String,
    /// The text to write, if it differs from the label.
    pub(super) text: Option<String>,
    /// The text to compare with typed letters, if it differs from the label.
    pub(super) filter: Option<String>,
    pub(super) note: Option<String>,
}

impl Choice {
    pub(super) fn new(label: impl Into<String>, detail: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            detail: detail.into(),
            text: None,
            filter: None,
            note: None,
        }
    }

    /// A number that can also be found by its name.
    fn named(label: String, detail: &str) -> Self {
        Self {
            filter: Some(format!("{label} {detail}")),
            ..Self::new(label, detail)
        }
    }
}

/// The values of a key in the section of an object or a sub-object.
pub(super) fn of_object(seen: &Seen, section: &Section, key: &str) -> Vec<Choice> {
    let (at, is_member) = match section.place {
        Place::Object(index) => (Address::new(index, 0), false),
        Place::Member(index, sub) => (Address::new(index, sub), true),
        _ => return Vec::new(),
    };
    match key.to_ascii_lowercase().as_str() {
        "datatype" => data_types(|code| format!("0x{code:04X}")),
        "objecttype" => object_codes(is_member, |code| format!("0x{code:X}")),
        "accesstype" => accesses(),
        "pdomapping" => vec![
            Choice::new("0", "the value cannot be mapped into a PDO"),
            Choice::new("1", "the value can be mapped into a PDO"),
        ],
        "objflags" => vec![
            Choice::new("0", "no flags"),
            Choice::new("1", "tools do not write the object on a download"),
            Choice::new("2", "tools do not read the object on a scan"),
            Choice::new("3", "tools do neither"),
        ],
        key if is_value_key(key) => value(seen, at),
        _ => Vec::new(),
    }
}

/// Default values: objects that can be mapped, COB-IDs and transmission types of CiA 301, and values with a meaning.
fn value(seen: &Seen, at: Address) -> Vec<Choice> {
    if is_mapping(at.index) && at.sub > 0 {
        return mappable(seen, at.index >= 0x1A00);
    }
    let offset = match (at.index, at.sub) {
        (0x1005, 0) => return vec![Choice::new("0x80", "COB-ID of SYNC")],
        (0x1012, 0) => return vec![Choice::new("0x100", "COB-ID of TIME")],
        (0x1014, 0) => 0x80,
        (0x1200, 1) => 0x600,
        (0x1200, 2) => 0x580,
        (0x1400..=0x1403, 1) => 0x200 + 0x100 * u32::from(at.index - 0x1400),
        (0x1800..=0x1803, 1) => 0x180 + 0x100 * u32::from(at.index - 0x1800),
        (0x1400..=0x15FF | 0x1800..=0x19FF, 2) => return transmission_types(at.index),
        _ => return known_values(seen, at),
    };
    let detail = format!("{offset:X}h + node ID");
    let mut choices = vec![Choice::new(format!("$NODEID+0x{offset:X}"), detail.clone())];
    if matches!(at.index, 0x1400..) {
        let label = format!("$NODEID+0x{:X}", 0x8000_0000 | offset);
        choices.push(Choice::new(label, format!("{detail}, not valid")));
    }
    choices
}

/// The transmission types in frequent use.
fn transmission_types(index: u16) -> Vec<Choice> {
    let types: &[u32] = match index {
        0x1800.. => &[255, 254, 0, 1, 253, 252],
        _ => &[255, 254, 1],
    };
    let choices = types.iter().filter_map(|number| {
        let says = words::transmission(index, *number)?;
        Some(Choice::new(format!("{number}"), says))
    });
    choices.collect()
}

/// The values that a document of CiA lists for an object, or those of a BOOLEAN.
fn known_values(seen: &Seen, at: Address) -> Vec<Choice> {
    let profile = standard::profile(&seen.description);
    let listed = outline::meanings(profile, at.index, at.sub);
    if !listed.is_empty() {
        let choices = listed.into_iter();
        return choices
            .map(|(number, says)| Choice::named(format!("{number}"), says))
            .collect();
    }
    let entry = seen.description.entry(at);
    match entry.and_then(|entry| entry.data_type.as_deref()) {
        Some(DataType::Boolean) => vec![Choice::new("0", "false"), Choice::new("1", "true")],
        _ => Vec::new(),
    }
}

/// The values of an attribute of an object or a sub-object in an XDD.
pub(super) fn of_attribute(seen: &Seen, place: Place, name: &str) -> Vec<Choice> {
    let at = match place {
        Place::Object(index) => Address::new(index, 0),
        Place::Member(index, sub) => Address::new(index, sub),
        _ => return Vec::new(),
    };
    match name {
        "dataType" => data_types(|code| format!("{code:04X}")),
        "objectType" => object_codes(matches!(place, Place::Member(..)), |code| format!("{code}")),
        "accessType" => {
            let mut all = accesses();
            // The schema gives the direction in PDOmapping.
            all.retain(|choice| !matches!(choice.label.as_str(), "rwr" | "rww"));
            all
        }
        "PDOmapping" => vec![
            Choice::new("no", "the value cannot be mapped into a PDO"),
            Choice::new("default", "a PDO maps the value, and it can be changed"),
            Choice::new("optional", "the value can be mapped into a PDO"),
            Choice::new("TPDO", "the value can be mapped into a TPDO only"),
            Choice::new("RPDO", "the value can be mapped into an RPDO only"),
        ],
        "defaultValue" | "actualValue" | "value" => value(seen, at),
        _ => Vec::new(),
    }
}

/// The values that the schema of CiA 311 lists for an attribute.
pub(super) fn of_schema(element: &str, name: &str) -> Vec<Choice> {
    if matches!(
        (element, name),
        ("supportedBaudRate", "value")
            | ("baudRate", "defaultValue")
            | ("deviceCommissioning", "actualBaudRate")
    ) {
        let rates = [10, 20, 50, 125, 250, 500, 800, 1000].into_iter();
        return rates
            .map(|rate| Choice::new(format!("{rate} Kbps"), format!("{rate} kbit/s")))
            .collect();
    }
    let mut attributes = od_eds::xdd::attributes(element).iter();
    match attributes.find(|own| own.name == name).map(|own| own.value) {
        Some(od_eds::xdd::Value::Words(words) | od_eds::xdd::Value::Capitals(words)) => {
            words.iter().map(|word| Choice::new(*word, "")).collect()
        }
        Some(od_eds::xdd::Value::Flag) => {
            vec![Choice::new("false", "no"), Choice::new("true", "yes")]
        }
        _ => Vec::new(),
    }
}

/// The data types, with their number as a text has it.
fn data_types(shown: impl Fn(u16) -> String) -> Vec<Choice> {
    let values = DataType::ALL.into_iter();
    let values = values.filter(|known| known.kind() != Kind::Record);
    values
        .map(|known| Choice::named(shown(known.code()), known.name()))
        .collect()
}

/// The object codes of objects or of sub-objects, with their number as a text has it.
fn object_codes(is_member: bool, shown: impl Fn(u8) -> String) -> Vec<Choice> {
    let codes = [
        ObjectCode::Var,
        ObjectCode::Array,
        ObjectCode::Record,
        ObjectCode::Domain,
    ];
    let codes = codes
        .into_iter()
        .filter(|code| !is_member || !code.has_members());
    codes
        .map(|code| Choice::named(shown(code.code()), code.name()))
        .collect()
}

fn accesses() -> Vec<Choice> {
    let access = Access::ALL.into_iter();
    access
        .map(|access| Choice::new(access.name(), words::access(access)))
        .collect()
}

/// The mapping entries of all objects that can be mapped in this direction.
fn mappable(seen: &Seen, into_tpdo: bool) -> Vec<Choice> {
    let description = &seen.description;
    let entries = description.entries().filter(|(_, entry)| {
        *entry.mappable
            && if into_tpdo {
                entry.access.maps_to_tpdo()
            } else {
                entry.access.maps_to_rpdo()
            }
    });
    let choices = entries.filter_map(|(at, entry)| {
        let bits = entry.data_type?.bits()?;
        let label = format!("0x{:04X}{:02X}{bits:02X}", at.index, at.sub);
        let name = words::name(description, at).unwrap_or_default();
        let shown = words::address(description, at);
        Some(Choice::named(
            label,
            &format!("{shown} {name}, {bits} bits"),
        ))
    });
    choices.collect()
}
