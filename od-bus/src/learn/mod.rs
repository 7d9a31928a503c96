//! An EDS from a device: which objects there are, their sizes, access, values and mapping.
//!
//! Objects of the standards have the names and types of the standards; of the others the type follows
//! from the size, and a comment says so. A value that the node has is the default.

mod limits;
mod probe;

use std::collections::{BTreeMap, BTreeSet};

use od_eds::outline::{data_type, profile_types, specified};
use od_eds::{Description, EntryDescription, ObjectDescription, Section, Spanned, Value};
use od_model::{Access, Address, DataType, Kind, ObjectCode};
use od_wire::NodeId;

use crate::conform::eds::is_touchy;
use crate::fault::Fault;
use crate::link::Link;
use probe::{Found, Probe, There};

/// How to learn.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// Probe limits by writing, and put the values back.
    pub writes: bool,
}

/// Reads all objects from 1000h to 9FFFh; `told` hears each index that is a multiple of 1000h.
///
/// # Errors
/// The link is lost, or the node falls silent.
pub fn learn(
    link: impl Link,
    node: NodeId,
    options: Options,
    mut told: impl FnMut(u16),
) -> Result<Description, Fault> {
    let mut probe = Probe::new(link, node);
    let mut objects = BTreeMap::new();
    let mut profile = 0;
    for index in 0x1000..=0x9FFF {
        if index % 0x1000 == 0 {
            told(index);
        }
        let found = members(&mut probe, index)?;
        if found.is_empty() {
            continue;
        }
        if let (0x1000, Some(bytes)) = (index, &found[0].bytes) {
            profile = u16::from_le_bytes([bytes[0], bytes.get(1).copied().unwrap_or(0)]);
        }
        let mut object = describe(&found, profile, node);
        if options.writes {
            for one in found.iter().filter(|one| one.writable == Some(true)) {
                probe_limits(&mut probe, one, &mut object)?;
            }
        }
        objects.insert(index, object);
    }
    map(&mut objects);
    let sections = sections(&objects, node, options);
    Ok(Description { sections, objects })
}

/// The values of an object.
fn members<L: Link>(probe: &mut Probe<L>, index: u16) -> Result<Vec<Found>, Fault> {
    let mut all = Vec::new();
    if probe.lacks(index)? {
        return Ok(all);
    }
    match probe.read(Address::new(index, 0))? {
        There::NoObject => return Ok(all),
        There::NoSubIndex => {}
        There::Value(found) => all.push(found),
    }
    // Sub-index 0 of what has members is their number, at least at first sight.
    let count = match all.first().map(|first| first.bytes.as_deref()) {
        Some(Some([count])) => *count,
        Some(_) => 0,
        None => 8,
    };
    for sub in 1..=0xFE {
        match probe.read(Address::new(index, sub))? {
            There::Value(found) => all.push(found),
            // Beyond the number there may be entries that are not used now.
            _ if sub > count => break,
            _ => {}
        }
        if all.len() == 1 && sub > 8 {
            break;
        }
    }
    Ok(all)
}

fn describe(found: &[Found], profile: u16, node: NodeId) -> ObjectDescription {
    let index = found[0].address.index;
    let is_whole = found.len() == 1 && found[0].address.sub == 0;
    let mut entries = BTreeMap::new();
    let mut types = BTreeSet::new();
    for one in found {
        let sub = one.address.sub;
        let known = known_type(profile, one, is_whole);
        let data_type = match (sub, known) {
            (0, None) if !is_whole => DataType::Unsigned8,
            (_, Some(known)) if fits(known, one) => known,
            _ => by_size(one),
        };
        if sub > 0 {
            types.insert(data_type);
        }
        let name = match (is_whole, sub) {
            (true, _) => name(index),
            (false, 0) => "Highest sub-index supported".into(),
            _ => format!("{} {sub}", name(index)),
        };
        let mut entry = EntryDescription::new(name, data_type);
        let access = match one.writable {
            _ if one.is_write_only => Access::Wo,
            Some(true) => Access::Rw,
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
        if known.is_none() && (sub > 0 || is_whole) {
            unknown.push("type by size");
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

fn name(index: u16) -> String {
    match specified(index) {
        Some(known) => known.name.into(),
        None => format!("Object {index:04X}h"),
    }
}

/// The type that a standard gives the value.
fn known_type(profile: u16, one: &Found, is_whole: bool) -> Option<DataType> {
    let Address { index, sub } = one.address;
    let of_profile = || {
        let all = profile_types(profile, index).iter().copied();
        let fits = |data_type: &DataType| (is_whole || sub > 0) && fits(*data_type, one);
        // Where a profile allows a number with or without sign, devices have it with sign.
        all.filter(fits)
            .max_by_key(|one| one.kind() == Kind::Signed)
    };
    data_type(index, sub, is_whole).or_else(of_profile)
}

/// Has the value the length of the type?
fn fits(data_type: DataType, found: &Found) -> bool {
    match (&found.bytes, data_type.size()) {
        (Some(bytes), Some(size)) => bytes.len() == size,
        _ => true,
    }
}

fn by_size(found: &Found) -> DataType {
    let Some(bytes) = &found.bytes else {
        return DataType::Unsigned32;
    };
    let is_text = !bytes.is_empty() && bytes.iter().all(|byte| (0x20..0x7F).contains(byte));
    match bytes.len() {
        1 => DataType::Unsigned8,
        2 => DataType::Unsigned16,
        3 => DataType::Unsigned24,
        4 => DataType::Unsigned32,
        8 if !is_text => DataType::Unsigned64,
        _ if is_text => DataType::VisibleString,
        _ => DataType::OctetString,
    }
}

/// The value as a default; an identifier of the predefined connection set follows the node ID.
fn default(address: Address, data_type: DataType, bytes: &[u8], node: NodeId) -> Option<Value> {
    let mut wide = [0; 8];
    match data_type.kind() {
        Kind::Text => return Some(Value::Text(String::from_utf8_lossy(bytes).into_owned())),
        Kind::Bytes => return Some(Value::Bytes(bytes.to_vec())),
        Kind::Real if bytes.len() == 4 => {
            let bits = [bytes[0], bytes[1], bytes[2], bytes[3]];
            return Some(Value::Real(f32::from_le_bytes(bits).into()));
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
    match is_cob_id && raw & 0x7F == node && raw & 0x780 != 0 {
        true => u32::try_from(raw - node).ok().map(Value::NodeId),
        false => Some(Value::Unsigned(raw)),
    }
}

fn probe_limits<L: Link>(
    probe: &mut Probe<L>,
    one: &Found,
    object: &mut ObjectDescription,
) -> Result<(), Fault> {
    let Some(entry) = object.entries.get_mut(&one.address.sub) else {
        return Ok(());
    };
    let Some(data_type) = entry.data_type.as_ref().map(|given| given.value) else {
        return Ok(());
    };
    if is_touchy(one.address) {
        return Ok(());
    }
    let [low, high] = limits::limits(probe, one, data_type)?;
    entry.low = low.map(|low| Spanned::from(Value::Unsigned(low)));
    entry.high = high.map(|high| Spanned::from(Value::Unsigned(high)));
    for (key, text) in &mut entry.extra {
        if key == ";Learned" {
            *text = text.replace("limits", "numbers between the limits");
        }
    }
    Ok(())
}

/// What is mapped into a PDO can be.
fn map(objects: &mut BTreeMap<u16, ObjectDescription>) {
    let mappings = objects.range(0x1600..=0x1BFF);
    let entries = mappings.flat_map(|(_, object)| object.entries.iter());
    let mapped: Vec<u64> = entries
        .filter(|(sub, _)| **sub > 0)
        .filter_map(|(_, entry)| match entry.default.as_ref()?.value {
            Value::Unsigned(raw) => Some(raw),
            _ => None,
        })
        .collect();
    for raw in mapped {
        let object = objects.get_mut(&((raw >> 16) as u16));
        if let Some(entry) = object.and_then(|object| object.entries.get_mut(&((raw >> 8) as u8))) {
            entry.mappable = Spanned::from(true);
        }
    }
}

fn sections(
    objects: &BTreeMap<u16, ObjectDescription>,
    node: NodeId,
    options: Options,
) -> Vec<Section> {
    let section = |name: &str, pairs: Vec<(&str, String)>| Section {
        name: Spanned::from(name.to_owned()),
        pairs: pairs
            .into_iter()
            .map(|(key, value)| (Spanned::from(key.to_owned()), Spanned::from(value)))
            .collect(),
    };
    let value = |index: u16, sub: u8| {
        let default = &objects.get(&index)?.entries.get(&sub)?.default;
        default.as_ref().map(|default| default.value.clone())
    };
    let number = |sub| match value(0x1018, sub) {
        Some(Value::Unsigned(number)) => format!("0x{number:08X}"),
        _ => "0".into(),
    };
    let name = match value(0x1008, 0) {
        Some(Value::Text(text)) => text,
        _ => format!("Node {}", node.raw()),
    };
    let pdos = |first: u16| objects.range(first..first + 0x200).count().to_string();
    let mut info = vec![
        ("VendorName", String::new()),
        ("VendorNumber", number(1)),
        ("ProductName", name.clone()),
        ("ProductNumber", number(2)),
        ("RevisionNumber", number(3)),
        ("OrderCode", String::new()),
    ];
    for rate in ["10", "20", "50", "125", "250", "500", "800", "1000"] {
        let key: &'static str = match rate {
            "10" => "BaudRate_10",
            "20" => "BaudRate_20",
            "50" => "BaudRate_50",
            "125" => "BaudRate_125",
            "250" => "BaudRate_250",
            "500" => "BaudRate_500",
            "800" => "BaudRate_800",
            _ => "BaudRate_1000",
        };
        info.push((key, "1".into()));
    }
    info.extend([
        ("SimpleBootUpMaster", "0".into()),
        ("SimpleBootUpSlave", "1".into()),
        ("Granularity", "8".into()),
        ("DynamicChannelsSupported", "0".into()),
        ("GroupMessaging", "0".into()),
        ("NrOfRXPDO", pdos(0x1400)),
        ("NrOfTXPDO", pdos(0x1800)),
        ("LSS_Supported", "0".into()),
    ]);
    let lines = [
        format!("Learned by odkit from node {}.", node.raw()),
        "Not known: bit rates, LSS, which values are saved, which objects can be mapped.".into(),
        match options.writes {
            true => "Limits were probed.".into(),
            false => "Limits were not probed (--allow-writes).".to_owned(),
        },
    ];
    let mut comments = vec![("Lines", lines.len().to_string())];
    comments.extend(["Line1", "Line2", "Line3"].into_iter().zip(lines));
    let dummies = [
        "Dummy0001",
        "Dummy0002",
        "Dummy0003",
        "Dummy0004",
        "Dummy0005",
        "Dummy0006",
        "Dummy0007",
    ];
    let time = || "12:00AM".to_owned();
    let date = || "01-01-2000".to_owned();
    vec![
        section(
            "FileInfo",
            vec![
                ("FileName", "learned.eds".into()),
                ("FileVersion", "1".into()),
                ("FileRevision", "0".into()),
                ("EDSVersion", "4.0".into()),
                ("Description", format!("Learned from {name}")),
                ("CreationTime", time()),
                ("CreationDate", date()),
                ("CreatedBy", "odkit learn".into()),
                ("ModificationTime", time()),
                ("ModificationDate", date()),
                ("ModifiedBy", "odkit learn".into()),
            ],
        ),
        section("DeviceInfo", info),
        section(
            "DummyUsage",
            dummies.map(|name| (name, "0".into())).to_vec(),
        ),
        section("Comments", comments),
    ]
}
