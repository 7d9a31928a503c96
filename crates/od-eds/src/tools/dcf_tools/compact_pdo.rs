//! PDOs of CompactPDO, which dcf-tools expands before its checks.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::device::unread;
use super::rules::MISSING;
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
        let name = |index: u32| format!("{index:04X}");
        let mut there = (0..512)
            .filter(|at| ini.section(&name(first + at)).is_some())
            .count() as i128;
        for at in 0..512 {
            if count <= there {
                break;
            }
            let own = name(first + at);
            if ini.section(&own).is_some() {
                continue;
            }
            there += 1;
            let listed = ini
                .section("OptionalObjects")
                .and_then(|list| ini.get(list, "SupportedObjects"));
            let Some(listed) = listed.and_then(|pair| int(&pair.value, 0)) else {
                let finding = MISSING.at(span).fact("section", "OptionalObjects");
                reading.push(finding.fact("name", "SupportedObjects"));
                return;
            };
            list(ini, listed + 1, &own);
            let mut members = Vec::new();
            for (bit, sub, data_type) in MEMBERS_OF_PDO
                .into_iter()
                .filter(|(bit, ..)| bits & bit != 0)
            {
                let cob = match at {
                    0..4 => format!("$NODEID+0x{:X}", at * 0x100 + cob_id),
                    _ => "0x80000000".into(),
                };
                members.push((sub, data_type, if bit == 1 { cob } else { String::new() }));
            }
            let highest = members.last().map_or(0, |(sub, ..)| *sub);
            let pairs = |name: &str, data_type: &str, access: &str, default: &str| {
                let mut pairs = alloc::vec![
                    ("ParameterName", name.to_string()),
                    ("DataType", data_type.to_string()),
                    ("AccessType", access.to_string()),
                ];
                if !default.is_empty() {
                    pairs.push(("DefaultValue", default.to_string()));
                }
                pairs
            };
            let total = (members.len() + 1).to_string();
            let object = [
                ("SubNumber", total),
                ("ParameterName", own.clone()),
                ("ObjectType", "0x09".into()),
            ];
            ini.add(own.clone(), span, &object);
            ini.add(
                format!("{own}sub0"),
                span,
                &pairs(
                    "highest sub-index supported",
                    "0x0005",
                    "const",
                    &highest.to_string(),
                ),
            );
            for (sub, data_type, default) in members {
                ini.add(
                    format!("{own}sub{sub:X}"),
                    span,
                    &pairs("PDO", data_type, "rw", &default),
                );
            }
            let own = name(mapping + at);
            if ini.section(&own).is_none() {
                list(ini, listed + 2, &own);
                let mut object = pairs("PDO mapping parameter", "0x0007", "rw", "");
                object.extend([
                    ("ObjectType", "0x09".to_string()),
                    ("CompactSubObj", "0x40".to_string()),
                ]);
                ini.add(own, span, &object);
            }
        }
    }
}

fn list(ini: &mut Ini<'_>, number: i128, name: &str) {
    ini.set(
        "OptionalObjects",
        "SupportedObjects".into(),
        number.to_string(),
    );
    ini.set("OptionalObjects", number.to_string(), format!("0x{name}"));
}
