//! A description as JSON, for tools that need tables instead of a parser.
//!
//! `docs/odkit-dictionary-2.schema.json` is the schema of the text.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::json;

use crate::description::{Description, EntryDescription, ObjectDescription, Section, Value};
use crate::scan::names::List;
use crate::scan::number::number;
use crate::span::Spanned;
use crate::subject::start_value;
use od_model::{Address, Visible};

/// The name of the format; its number changes with each change that breaks readers.
const FORMAT: &str = "odkit-dictionary/2";

/// Returns a JSON object with the whole content of the description: file, identity, device,
/// commissioning, sections and objects. `source` is named in it.
///
/// The text is written object by object, so a large description needs little more memory than its text.
pub fn write(description: &Description, source: &str) -> String {
    let whole = Whole {
        description,
        source,
    };
    // This cannot fail: a String takes all text, and all maps have text keys.
    let text = serde_json::to_string_pretty(&whole).unwrap_or_default();
    Visible(&text).json().into_owned()
}

struct Whole<'a> {
    description: &'a Description,
    source: &'a str,
}

impl Serialize for Whole<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let description = self.description;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("format", FORMAT)?;
        map.serialize_entry("source", self.source)?;
        map.serialize_entry("file", &file(description))?;
        map.serialize_entry("identity", &identity(description))?;
        map.serialize_entry("device", &device(description))?;
        map.serialize_entry("commissioning", &commissioning(description))?;
        let sections: Vec<_> = description.sections.iter().map(section).collect();
        map.serialize_entry("sections", &sections)?;
        map.serialize_entry("objects", &Objects(description))?;
        map.end()
    }
}

struct Objects<'a>(&'a Description);

impl Serialize for Objects<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let objects = self.0.objects.iter();
        serializer.collect_seq(objects.map(|(index, described)| object(*index, described)))
    }
}

/// The text of a key; null if it is missing or empty.
fn text<'a>(section: Option<&'a Section>, key: &str) -> Option<&'a str> {
    let value = section?.get(key)?.value.trim();
    (!value.is_empty()).then_some(value)
}

/// The number of a key; null if it is missing or not a number.
fn integer(section: Option<&Section>, key: &str) -> serde_json::Value {
    let found = text(section, key).and_then(number);
    found.map_or(serde_json::Value::Null, exact)
}

/// A flag; null if it is missing.
fn flag(section: Option<&Section>, key: &str) -> Option<bool> {
    text(section, key).and_then(number).map(|flag| flag != 0)
}

fn file(description: &Description) -> serde_json::Value {
    let info = description.section("FileInfo");
    let made = |what: &str, by: &str| {
        json!({
            "date": text(info, &format!("{what}Date")),
            "time": text(info, &format!("{what}Time")),
            "by": text(info, by),
        })
    };
    json!({
        "name": text(info, "FileName"),
        "version": text(info, "FileVersion"),
        "revision": text(info, "FileRevision"),
        "edsVersion": text(info, "EDSVersion"),
        "description": text(info, "Description"),
        "created": made("Creation", "CreatedBy"),
        "modified": made("Modification", "ModifiedBy"),
    })
}

fn identity(description: &Description) -> serde_json::Value {
    let info = description.section("DeviceInfo");
    json!({
        "vendorName": text(info, "VendorName"),
        "vendorNumber": integer(info, "VendorNumber"),
        "productName": text(info, "ProductName"),
        "productNumber": integer(info, "ProductNumber"),
        "revisionNumber": integer(info, "RevisionNumber"),
        "orderCode": text(info, "OrderCode"),
    })
}

fn device(description: &Description) -> serde_json::Value {
    let info = description.section("DeviceInfo");
    let rates = info.map_or(&[][..], |info| &info.pairs).iter();
    let rates = rates.filter_map(|(key, value)| {
        let (word, rate) = key.split_at_checked("BaudRate_".len())?;
        let is_rate = word.eq_ignore_ascii_case("BaudRate_") && number(value) == Some(1);
        rate.parse().ok().filter(|_| is_rate)
    });
    let rates: Vec<u32> = rates.collect();
    json!({
        "bitRates": rates,
        "simpleBootUpMaster": flag(info, "SimpleBootUpMaster"),
        "simpleBootUpSlave": flag(info, "SimpleBootUpSlave"),
        "granularity": integer(info, "Granularity"),
        "dynamicChannels": integer(info, "DynamicChannelsSupported"),
        "groupMessaging": flag(info, "GroupMessaging"),
        "rpdos": integer(info, "NrOfRXPDO"),
        "tpdos": integer(info, "NrOfTXPDO"),
        "lss": flag(info, "LSS_Supported"),
    })
}

fn commissioning(description: &Description) -> Option<serde_json::Value> {
    let found = description.commissioning()?;
    Some(json!({
        "nodeId": found.node_id,
        "nodeName": found.node_name,
        "bitRate": found.bit_rate,
        "network": found.network,
        "networkName": found.network_name,
        "isManager": found.is_manager,
        "serialNumber": found.serial_number,
    }))
}

/// A section key by key: the same key may occur twice.
fn section(section: &Section) -> serde_json::Value {
    let keys = section.pairs.iter();
    let keys = keys.map(|(key, value)| json!({ "key": key.value, "value": value.value }));
    let keys: Vec<_> = keys.collect();
    json!({ "name": section.name.value, "keys": keys })
}

fn object(index: u16, object: &ObjectDescription) -> serde_json::Value {
    let entries = object.entries.iter();
    let entries = entries.map(|(sub, one)| entry(Address::new(index, *sub), one));
    let list = match List::of(index) {
        List::Mandatory => "mandatory",
        List::Optional => "optional",
        List::Manufacturer => "manufacturer",
    };
    json!({
        "index": format!("0x{index:04X}"),
        "name": object.name.value,
        "type": object.code.name(),
        "list": list,
        "subNumber": object.sub_number.map(|number| number.value),
        "flags": object.flags,
        "extra": extra(&object.extra),
        "entries": entries.collect::<Vec<_>>(),
    })
}

fn entry(address: Address, entry: &EntryDescription) -> serde_json::Value {
    let group = entry.group_at(address).name();
    let data_type = entry.data_type.map(|found| found.value);
    let mappable = *entry.mappable;
    json!({
        "sub": address.sub,
        "name": entry.name.value,
        "dataType": data_type.map(|found| found.name()),
        "bits": data_type.and_then(|found| found.bits()),
        "access": entry.access.name(),
        "mappable": mappable,
        "tpdo": mappable && entry.access.maps_to_tpdo(),
        "rpdo": mappable && entry.access.maps_to_rpdo(),
        "default": value(&entry.default),
        "parameter": value(&entry.parameter),
        "low": value(&entry.low),
        "high": value(&entry.high),
        "maps": maps(address, entry),
        "storage": group,
        "flags": entry.flags,
        "extra": extra(&entry.extra),
    })
}

/// The object that a mapping entry maps.
fn maps(address: Address, entry: &EntryDescription) -> Option<serde_json::Value> {
    let is_mapping = matches!(address.index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
    let Some(Value::Unsigned(mapped @ 1..)) = start_value(entry).map(|value| &value.value) else {
        return None;
    };
    let mapped = u32::try_from(*mapped)
        .ok()
        .filter(|_| is_mapping && address.sub > 0)?;
    Some(json!({
        "index": format!("0x{:04X}", mapped >> 16),
        "sub": mapped >> 8 & 0xFF,
        "bits": mapped & 0xFF,
    }))
}

/// Texts of other keys, and invalid ones, by key.
fn extra(pairs: &[(String, String)]) -> serde_json::Value {
    let pairs = pairs.iter();
    pairs
        .map(|(key, value)| (key.clone(), serde_json::Value::from(value.as_str())))
        .collect()
}

fn value(value: &Option<Spanned<Value>>) -> serde_json::Value {
    match value.as_deref() {
        None => serde_json::Value::Null,
        Some(Value::Unsigned(number)) => exact(i128::from(*number)),
        Some(Value::Signed(number)) => exact(i128::from(*number)),
        Some(Value::Real(number)) if number.is_finite() => (*number).into(),
        Some(Value::Real(number)) => number.to_string().into(),
        Some(Value::NodeId(offset)) => json!({ "nodeIdPlus": offset }),
        Some(Value::Text(text)) => text.as_str().into(),
        Some(Value::Bytes(bytes)) => {
            let hex: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
            json!({ "hex": hex })
        }
    }
}

/// A number in the range that every JSON reader keeps exact, otherwise a text.
fn exact(number: i128) -> serde_json::Value {
    const EXACT: i128 = 1 << 53;
    match i64::try_from(number) {
        Ok(small) if number.abs() <= EXACT => small.into(),
        _ => number.to_string().into(),
    }
}
