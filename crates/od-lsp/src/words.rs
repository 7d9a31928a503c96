//! Descriptions of values of an EDS.

use od_eds::outline::meaning;
use od_eds::{Description, EntryDescription, Value};
use od_model::{Access, Address, DataType, ObjectCode, TransmissionType, Visible};

use crate::cob_ids::{self, CobId};
use crate::mentions::{Mapped, is_mapping};
use crate::standard;

/// An address in words: `6004h` for a VAR, otherwise `1018h:01`.
pub(crate) fn address(description: &Description, address: Address) -> String {
    let object = description.objects.get(&address.index);
    match object {
        Some(object) if !object.code.has_members() && address.sub == 0 => {
            format!("{:04X}h", address.index)
        }
        _ => address.to_string(),
    }
}

/// The name of an object or a sub-object in the file.
pub(crate) fn name(description: &Description, address: Address) -> Option<&str> {
    let object = description.objects.get(&address.index)?;
    let name = match object.entries.get(&address.sub) {
        Some(entry) if object.code.has_members() => &entry.name,
        _ => &object.name,
    };
    (!name.is_empty()).then_some(name.value.as_str())
}

/// An object with its name: `2001h "Gain"`.
pub(crate) fn object(description: &Description, at: Address) -> String {
    let shown = address(description, at);
    match name(description, at) {
        Some(name) => format!("{shown} {name:?}"),
        None => shown,
    }
}

/// A mapping entry: `2000h:00, 16 bits`.
pub(crate) fn mapping(mapped: Mapped) -> String {
    let bits = if mapped.bits == 1 { "bit" } else { "bits" };
    format!("{}, {} {bits}", mapped.object, mapped.bits)
}

/// The name for a mapping entry: that of the object, or of the data type of a gap.
pub(crate) fn mapped_name(description: &Description, mapped: Mapped) -> Option<String> {
    if let Some(name) = name(description, mapped.object) {
        return Some(name.to_owned());
    }
    let dummy = DataType::from_code(mapped.object.index)?;
    Some(format!("dummy entry, {}", dummy.name()))
}

/// The value of an entry in words, if they add information to the text.
pub(crate) fn value(
    description: &Description,
    at: Address,
    entry: &EntryDescription,
    value: &Value,
) -> Option<String> {
    if cob_ids::is_one(at) {
        let node = description.commissioned_node_id();
        return CobId::of(value).map(|id| {
            let of_node = node.and_then(|node| Some((node, id.of_node(node)?)));
            let of_node = of_node.map(|(node, id)| format!(" ({id:X}h for node {node})"));
            format!("COB-ID {}{}", id.words(at), of_node.unwrap_or_default())
        });
    }
    let number = value.integer(0);
    if is_mapping(at.index) && at.sub > 0 {
        let mapped = Mapped::of(number?)?;
        let name = mapped_name(description, mapped);
        let name = name.map_or_else(String::new, |name| format!(" ({name})"));
        return Some(format!("maps {}{name}", mapping(mapped)));
    }
    let profile = standard::profile(description);
    if let Some(special) = special(at, number, profile) {
        return Some(special);
    }
    let meaning = number
        .and_then(|number| i64::try_from(number).ok())
        .and_then(|number| meaning(profile, at.index, at.sub, number));
    let shown = plain(entry, value);
    match meaning {
        Some(meaning) => Some(format!("{}: {meaning}", shown?)),
        None => shown,
    }
}

/// A value without the meaning of its object.
fn plain(entry: &EntryDescription, value: &Value) -> Option<String> {
    match value {
        Value::NodeId(offset) => Some(format!("{offset:X}h + node ID")),
        Value::Unsigned(number @ 0..=9) => Some(number.to_string()),
        Value::Unsigned(number) => Some(format!("{number} ({number:X}h)")),
        Value::Signed(number) => {
            let bits = entry.data_type.and_then(|data_type| data_type.size());
            let mask = bits.map_or(u64::MAX, |bytes| u64::MAX >> (64 - 8 * bytes.clamp(1, 8)));
            Some(format!("{number} ({:X}h)", (*number as u64) & mask))
        }
        Value::Real(number) => Some(number.to_string()),
        Value::Text(text) => Some(format!("{:?}, {} bytes", text, text.len())),
        Value::Bytes(bytes) => Some(format!(
            "{} ({} bytes)",
            od_model::values::hex(bytes.get(..32).unwrap_or(bytes)),
            bytes.len()
        )),
    }
}

/// Values with a meaning whose words are not in the table of meanings: numbers with a unit, types and error codes.
fn special(at: Address, number: Option<i128>, profile: Option<u16>) -> Option<String> {
    let number = u32::try_from(number?).ok()?;
    let [low, high, third, _] = number.to_le_bytes();
    let half = u16::from_le_bytes([low, high]);
    Some(match (at.index, at.sub) {
        (0x1000, 0) => match half {
            0 => "no device profile".into(),
            profile if number >> 16 == 0xFFFF => {
                format!("device profile CiA {profile}, one of several logical devices")
            }
            profile => match meaning(Some(profile), 0x1000, 0, number.into()) {
                Some(device) => format!("device profile CiA {profile}: {device}"),
                None => format!(
                    "device profile CiA {profile}, additional information {:04X}h",
                    number >> 16
                ),
            },
        },
        (0x1003, 1..) => match number >> 16 {
            0 => error_code(profile, half),
            more => format!(
                "{}, additional information {more:04X}h",
                error_code(profile, half)
            ),
        },
        // The second axis of a drive is 800h higher.
        (0x6000..=0x9FFF, 0) if profile == Some(402) && at.index % 0x800 == 0x3F => {
            error_code(profile, half)
        }
        (0x1006 | 0x1007, 0) => format!("{number} µs"),
        (0x1015 | 0x102A, 0) => format!("inhibit time {}.{} ms", number / 10, number % 10),
        (0x1018, 3) => format!("major revision {}, minor revision {half}", number >> 16),
        (0x1019, 0) if number == 0 => "SYNC without a counter".into(),
        (0x1020, 1) | (0x1F26 | 0x1F53, 1..) => format!("{number} days after 1 January 1984"),
        (0x1020, 2) | (0x1F27 | 0x1F54, 1..) => {
            let seconds = number / 1000;
            let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
            format!("{hours:02}:{minutes:02}:{:02} after midnight", seconds % 60)
        }
        (0x1F89, 0) if number == 0 => "the master waits for its slaves without a limit".into(),
        (0x1F89, 0) => format!("{number} ms"),
        (0x100C | 0x1017, 0) if number == 0 => "off".into(),
        (0x100C | 0x1017, 0) => format!("{number} ms"),
        (0x1016, 1..) if number == 0 => "not used".into(),
        (0x1016, 1..) => format!("heartbeat of node {third} within {half} ms"),
        (0x1400..=0x15FF | 0x1800..=0x19FF, 2) => transmission(at.index, number)?,
        (0x1400..=0x15FF | 0x1800..=0x19FF, 3) => {
            format!("inhibit time {}.{} ms", number / 10, number % 10)
        }
        (0x1400..=0x15FF | 0x1800..=0x19FF, 5) if number == 0 => "event timer off".into(),
        (0x1400..=0x15FF | 0x1800..=0x19FF, 5) => format!("event timer {number} ms"),
        _ => return None,
    })
}

fn error_code(profile: Option<u16>, code: u16) -> String {
    format!("{code:04X}h: {}", od_wire::emcy::text(profile, code))
}

/// The transmission type of an RPDO or a TPDO (CiA 301, chapters 7.5.2.35 and 7.5.2.37).
pub(crate) fn transmission(index: u16, number: u32) -> Option<String> {
    let kind = TransmissionType::new(number.try_into().ok()?);
    let is_rpdo = index < 0x1800;
    Some(match (number, kind.cycle()) {
        _ if kind.is_reserved(is_rpdo) => return None,
        _ if is_rpdo && kind.is_synchronous() => "synchronous".into(),
        (_, Some(1)) => "synchronous, with every SYNC".into(),
        (_, Some(cycle)) => format!("synchronous, once in {cycle} SYNCs"),
        (0, _) => "synchronous (acyclic)".into(),
        (252, _) => "RTR-only (synchronous)".into(),
        (253, _) => "RTR-only (event-driven)".into(),
        (254, _) => "event-driven (manufacturer-specific)".into(),
        _ => "event-driven (device profile and application profile)".into(),
    })
}

/// An access type in words.
pub(crate) const fn access(access: Access) -> &'static str {
    match access {
        Access::Ro => "a master can read the value",
        Access::Wo => "a master can write the value",
        Access::Rw => "a master can read and write the value",
        Access::Rwr => "a master can read and write the value; it can be mapped into a TPDO only",
        Access::Rww => "a master can read and write the value; it can be mapped into an RPDO only",
        Access::Const => "a master can read the value, which never changes",
    }
}

/// PDOMapping in words.
pub(crate) const fn mappable(is: bool) -> &'static str {
    if is {
        "The value can be mapped into a PDO."
    } else {
        "The value cannot be mapped into a PDO."
    }
}

/// An object code in words.
pub(crate) const fn code(code: ObjectCode) -> &'static str {
    match code {
        ObjectCode::Null => "no value",
        ObjectCode::Domain => "a large number of bytes",
        ObjectCode::DefType => "the definition of a type",
        ObjectCode::DefStruct => "the definition of a record",
        ObjectCode::Var => "a single value",
        ObjectCode::Array => "sub-objects of one type",
        ObjectCode::Record => "sub-objects of different types",
    }
}

/// A data type in words: its name, and its size or range.
pub(crate) fn data_type(data_type: DataType) -> String {
    match data_type.integer_range() {
        Some((low, high)) => format!("{}, {low} to {high}", data_type.name()),
        None => data_type.name().into(),
    }
}

/// Heading of an object or a sub-object: address, name in the file, name in the standard.
pub(crate) fn heading(description: &Description, at: Address) -> String {
    let mut heading = format!("**{}**", address(description, at));
    let own = name(description, at);
    if let Some(own) = own {
        heading.push_str(&format!(" {}", escaped(own)));
    }
    let standard = standard::name(at.index, standard::profile(description));
    match standard {
        Some((name, source)) => heading.push_str(&format!(": {name} ({source})")),
        None => heading.push_str(&format!(": {}", standard::area(at.index))),
    }
    heading
}

/// A text of a file, escaped for Markdown.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if "\\`*_{}[]<>#|~&!".contains(c) {
            out.push('\\');
        }
        if od_model::is_hidden(c) {
            out.push_str(&Visible(c.encode_utf8(&mut [0; 4])).line())
        } else {
            out.push(c)
        }
    }
    out
}

/// Type and access: `UNSIGNED32, ro`.
pub(crate) fn of_type(entry: &EntryDescription) -> String {
    match entry.data_type {
        Some(data_type) => format!("{}, {}", data_type.name(), entry.access.name()),
        None => entry.access.name().into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_of_a_communication_object_has_its_meaning() {
        for (index, sub, number, words) in [
            (0x1003, 1, 0x8130, "8130h: life guard or heartbeat error"),
            (
                0x1003,
                2,
                0x0001_7121,
                "7121h: motor blocked, additional information 0001h",
            ),
            (
                0x683F,
                0,
                0x2310,
                "2310h: continuous over-current, device output side",
            ),
            (0x1800, 2, 1, "synchronous, with every SYNC"),
            (0x1800, 2, 2, "synchronous, once in 2 SYNCs"),
            (0x1400, 2, 2, "synchronous"),
            (0x1800, 3, 105, "inhibit time 10.5 ms"),
            (0x1800, 5, 0, "event timer off"),
            (0x1016, 1, 0x0005_03E8, "heartbeat of node 5 within 1000 ms"),
            (
                0x1000,
                0,
                0x0002_0196,
                "device profile CiA 406: multiturn encoder",
            ),
            (
                0x1000,
                0,
                0xFFFF_0191,
                "device profile CiA 401, one of several logical devices",
            ),
            (
                0x1000,
                0,
                0x0007_01A0,
                "device profile CiA 416, additional information 0007h",
            ),
            (0x1015, 0, 105, "inhibit time 10.5 ms"),
            (0x1018, 3, 0x0001_0002, "major revision 1, minor revision 2"),
            (0x1F26, 1, 366, "366 days after 1 January 1984"),
            (0x1F27, 1, 45_296_000, "12:34:56 after midnight"),
            (0x1F89, 0, 5000, "5000 ms"),
        ] {
            let address = Address::new(index, sub);
            assert_eq!(
                special(address, Some(number), Some(402)).as_deref(),
                Some(words),
                "{address}"
            );
        }
        assert_eq!(special(Address::new(0x1800, 2), Some(241), None), None);
        assert_eq!(special(Address::new(0x603F, 0), Some(0), Some(401)), None);
    }
}
