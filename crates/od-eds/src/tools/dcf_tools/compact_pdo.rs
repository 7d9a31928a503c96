//! PDOs of CompactPDO, which dcf-tools expands before its checks.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::device::unread;
use super::rules::MISSING;
use crate::span::Span;
use crate::tools::configparser::Ini;
use crate::tools::python::int;
use crate::tools::tool::Reading;

/// Communication and mapping parameters of a direction: their indices, and CAN-ID of the first one.
const DIRECTIONS: [(u32, u32, u32, &str); 2] = [
    (0x1400, 0x1600, 0x200, "NrOfRxPDO"),
    (0x1800, 0x1A00, 0x180, "NrOfTxPDO"),
];
/// Bits of CompactPDO, with type and sub-index.
const MEMBERS_OF_PDO: [(i128, u32, &str); 6] = [
    (1, 1, "0x0007"),
    (2, 2, "0x0005"),
    (4, 3, "0x0006"),
    (8, 4, "0x0005"),
    (16, 5, "0x0006"),
    (32, 6, "0x0005"),
];

/// Adds the PDO objects that CompactPDO replaces.
pub(super) fn add_compact_pdos(ini: &mut Ini<'_>, reading: &mut Reading) {
    let Some(info) = ini.section("DeviceInfo") else {
        return;
    };
    let span = info.header;
    let mut number = |key: &str| {
        let pair = ini.get(info, key).filter(|pair| !pair.value.is_empty())?;
        let read = int(&pair.value, 0);
        if read.is_none() {
            unread(reading, pair);
        }
        read
    };
    let bits = number("CompactPDO").unwrap_or(0);
    if bits == 0 {
        return;
    }
    let counts = DIRECTIONS.map(|(.., key)| number(key).unwrap_or(0));
    for ((first, mapping, cob_id, _), count) in DIRECTIONS.into_iter().zip(counts) {
        for at in missing(ini, first, count) {
            let listed = ini
                .section("OptionalObjects")
                .and_then(|list| ini.get(list, "SupportedObjects"));
            let Some(listed) = listed.and_then(|pair| int(&pair.value, 0)) else {
                let finding = MISSING.at(span).fact("section", "OptionalObjects");
                reading.push(finding.fact("name", "SupportedObjects"));
                return;
            };
            let cob_id = match at {
                0..4 => format!("$NODEID+0x{:X}", at * 0x100 + cob_id),
                _ => "0x80000000".into(),
            };
            add_communication(ini, span, &section(first + at), bits, &cob_id);
            list(ini, listed + 1, &section(first + at));
            let mapping = section(mapping + at);
            if ini.section(&mapping).is_none() {
                add_mapping(ini, span, &mapping);
                list(ini, listed + 2, &mapping);
            }
        }
    }
}

/// The name of the section of an object.
fn section(index: u32) -> String {
    format!("{index:04X}")
}

/// The PDOs, counted from 0, that a direction lacks to have this number of PDOs: the lowest without a section.
fn missing(ini: &Ini<'_>, first: u32, count: i128) -> Vec<u32> {
    let is_there = |at: &u32| ini.section(&section(first + at)).is_some();
    let there = (0..512).filter(is_there).count() as i128;
    let lacking = count.saturating_sub(there).clamp(0, 512) as usize;
    let without = (0..512).filter(|at| !is_there(at));
    without.take(lacking).collect()
}

/// Adds the communication parameter of a PDO, with the sub-indices of these bits.
fn add_communication(ini: &mut Ini<'_>, span: Span, name: &str, bits: i128, cob_id: &str) {
    let members = MEMBERS_OF_PDO.into_iter();
    let members: Vec<_> = members.filter(|(bit, ..)| bits & bit != 0).collect();
    let highest = members.last().map_or(0, |(_, sub, _)| *sub);
    let object = [
        ("SubNumber", (members.len() + 1).to_string()),
        ("ParameterName", name.to_string()),
        ("ObjectType", "0x09".into()),
    ];
    ini.add(name.into(), span, &object);
    let count = pairs(
        "highest sub-index supported",
        "0x0005",
        "const",
        &highest.to_string(),
    );
    ini.add(format!("{name}sub0"), span, &count);
    for (bit, sub, data_type) in members {
        let default = if bit == 1 { cob_id } else { "" };
        let member = pairs("PDO", data_type, "rw", default);
        ini.add(format!("{name}sub{sub:X}"), span, &member);
    }
}

/// Adds the mapping parameter of a PDO.
fn add_mapping(ini: &mut Ini<'_>, span: Span, name: &str) {
    let mut object = pairs("PDO mapping parameter", "0x0007", "rw", "");
    object.extend([
        ("ObjectType", "0x09".to_string()),
        ("CompactSubObj", "0x40".to_string()),
    ]);
    ini.add(name.into(), span, &object);
}

/// The keys of a value; without a default if it is empty.
fn pairs(name: &str, data_type: &str, access: &str, default: &str) -> Vec<(&'static str, String)> {
    let mut pairs = Vec::from([
        ("ParameterName", name.to_string()),
        ("DataType", data_type.to_string()),
        ("AccessType", access.to_string()),
    ]);
    if !default.is_empty() {
        pairs.push(("DefaultValue", default.to_string()));
    }
    pairs
}

/// Adds an object to the list of optional objects.
fn list(ini: &mut Ini<'_>, number: i128, name: &str) {
    ini.set(
        "OptionalObjects",
        "SupportedObjects".into(),
        number.to_string(),
    );
    ini.set("OptionalObjects", number.to_string(), format!("0x{name}"));
}
