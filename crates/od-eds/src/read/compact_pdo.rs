//! CompactPDO: PDO objects that a file only counts (CiA 306-1, DeviceInfo).
//!
//! Each bit of CompactPDO replaces a sub-index of the communication parameters,
//! bit 0 for sub-index 1. NrOfRXPDO and NrOfTXPDO count all PDOs. PDOs without
//! sections are added, lowest number first, and so is the missing half of a PDO.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::vec::Vec;

use crate::description::{Description, EntryDescription, ObjectDescription, Section, Value};
use crate::log::Log;
use crate::rules::pdo::i0515_compact_pdo;
use crate::scan::number::number;
use crate::span::{Span, Spanned};
use od_model::{Access, DataType, ObjectCode};

/// Largest number of PDOs of one direction in CiA 301.
const MOST: u16 = 512;
/// Limit of entries of a mapping: one bit each.
const ENTRIES: u8 = 64;

/// One of the two directions.
struct Direction {
    /// First communication parameter; its mapping is 200h above.
    base: u16,
    word: &'static str,
    key: &'static str,
    /// COB-ID of the first four, without the node ID.
    identifier: u32,
    /// Sub-index 4.
    fourth: &'static str,
}

const DIRECTIONS: [Direction; 2] = [
    Direction {
        base: 0x1400,
        word: "RPDO",
        key: "NrOfRXPDO",
        identifier: 0x200,
        fourth: "Compatibility entry",
    },
    Direction {
        base: 0x1800,
        word: "TPDO",
        key: "NrOfTXPDO",
        identifier: 0x180,
        fourth: "Reserved",
    },
];

/// The objects that CompactPDO replaces.
pub(crate) fn objects(
    description: &Description,
    log: &mut Log,
) -> BTreeMap<u16, ObjectDescription> {
    let mut made = BTreeMap::new();
    let Some(info) = description.section("DeviceInfo") else {
        return made;
    };
    let Some((mask, span)) = mask(info) else {
        return made;
    };
    for direction in &DIRECTIONS {
        let given = info.get(direction.key).and_then(|given| number(given));
        let count = given
            .and_then(|n| u16::try_from(n).ok())
            .unwrap_or(0)
            .min(MOST);
        let has = |index: u16| description.objects.contains_key(&index);
        let there = |n: &u16| has(direction.base + n) || has(direction.base + n + 0x200);
        let described = (0..MOST).filter(there).count() as u16;
        let missing = (0..MOST)
            .filter(|n| !there(n))
            .take(usize::from(count.saturating_sub(described)));
        let halves = (0..MOST).filter(|n| count > 0 && there(n));
        let mut numbers: Vec<u16> = missing.chain(halves).collect();
        numbers.sort_unstable();
        let before = made.len();
        for n in numbers {
            if !has(direction.base + n) {
                made.insert(direction.base + n, communication(direction, n, mask, span));
            }
            if !has(direction.base + n + 0x200) {
                made.insert(direction.base + n + 0x200, mapping(direction, span));
            }
        }
        if made.len() > before {
            let (word, count) = (direction.word, made.len() - before);
            log.push(i0515_compact_pdo::finding(span, count, word));
        }
    }
    made
}

/// The sub-indices of the communication parameters, as bits.
fn mask(info: &Section) -> Option<(u8, Span)> {
    let given = info.get("CompactPDO")?;
    let mask = u8::try_from(number(given)?).ok()? & 0x3F;
    (mask != 0).then_some((mask, given.span))
}

fn communication(direction: &Direction, n: u16, mask: u8, span: Span) -> ObjectDescription {
    let cob_id = match n {
        0..4 => Value::NodeId(direction.identifier + 0x100 * u32::from(n)),
        // Not valid until a master assigns a CAN-ID.
        _ => Value::Unsigned(0x8000_0000),
    };
    let highest = 8 - mask.leading_zeros();
    let word = direction.word;
    let mut entries = BTreeMap::from([(
        0,
        entry(
            "Highest sub-index supported",
            DataType::Unsigned8,
            Access::Const,
            Some(Value::Unsigned(u64::from(highest))),
            span,
        ),
    )]);
    let members = [
        (
            format!("COB-ID used by {word}"),
            DataType::Unsigned32,
            Some(cob_id),
        ),
        ("Transmission type".into(), DataType::Unsigned8, None),
        ("Inhibit time".into(), DataType::Unsigned16, None),
        (direction.fourth.into(), DataType::Unsigned8, None),
        ("Event timer".into(), DataType::Unsigned16, None),
        ("SYNC start value".into(), DataType::Unsigned8, None),
    ];
    for (bit, (name, data_type, default)) in (0u8..).zip(members) {
        if mask & 1 << bit != 0 {
            entries.insert(bit + 1, entry(&name, data_type, Access::Rw, default, span));
        }
    }
    record(format!("{word} communication parameter"), entries, span)
}

fn mapping(direction: &Direction, span: Span) -> ObjectDescription {
    let mut entries = BTreeMap::from([(
        0,
        entry(
            "Number of mapped application objects",
            DataType::Unsigned8,
            Access::Rw,
            Some(Value::Unsigned(0)),
            span,
        ),
    )]);
    for sub in 1..=ENTRIES {
        let name = format!("Application object {sub}");
        entries.insert(
            sub,
            entry(&name, DataType::Unsigned32, Access::Rw, None, span),
        );
    }
    record(
        format!("{} mapping parameter", direction.word),
        entries,
        span,
    )
}

fn record(
    name: alloc::string::String,
    entries: BTreeMap<u8, EntryDescription>,
    span: Span,
) -> ObjectDescription {
    ObjectDescription {
        code: Spanned::new(ObjectCode::Record, span),
        name: Spanned::new(name, span),
        sub_number: Some(Spanned::new(entries.len() as u32, span)),
        entries,
        flags: 0,
        extra: Vec::new(),
        span,
    }
}

fn entry(
    name: &str,
    data_type: DataType,
    access: Access,
    default: Option<Value>,
    span: Span,
) -> EntryDescription {
    EntryDescription {
        access: Spanned::new(access, span),
        default: default.map(|value| Spanned::new(value, span)),
        span,
        ..EntryDescription::new(name, data_type)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pdos_without_sections_are_added() {
        let parsed = crate::parse(
            "[DeviceInfo]\nNrOfRXPDO=6\nNrOfTXPDO=1\nCompactPDO=0x13\n\
             [1401]\nObjectType=9\nSubNumber=0\n",
        );
        let objects = &parsed.description.objects;
        let indices: Vec<u16> = objects.keys().copied().collect();
        let mut expected: Vec<u16> = (0x1400..=0x1405).chain(0x1600..=0x1605).collect();
        expected.extend([0x1800, 0x1A00]);
        assert_eq!(indices, expected);
        let subs: Vec<u8> = objects[&0x1400].entries.keys().copied().collect();
        assert_eq!(subs, [0, 1, 2, 5]);
        let default = |index: u16, sub: u8| {
            let entry = &objects[&index].entries[&sub];
            entry.default.as_ref().map(|default| default.value.clone())
        };
        assert_eq!(default(0x1400, 0), Some(Value::Unsigned(5)));
        assert_eq!(default(0x1403, 1), Some(Value::NodeId(0x500)));
        assert_eq!(default(0x1404, 1), Some(Value::Unsigned(0x8000_0000)));
        assert_eq!(default(0x1800, 1), Some(Value::NodeId(0x180)));
        assert_eq!(objects[&0x1A00].entries.len(), 65);
        // A PDO with a section has the content of the section.
        assert!(objects[&0x1401].entries.is_empty());
        let codes: Vec<_> = parsed.findings.iter().map(|d| d.code()).collect();
        assert_eq!(codes.iter().filter(|code| **code == "I0515").count(), 2);
        let again = crate::parse(&crate::write(&parsed.description)).description;
        assert!(again.objects == parsed.description.objects);
    }

    #[test]
    fn too_large_a_count_makes_no_more_than_the_limit() {
        let text = "[DeviceInfo]\nNrOfRXPDO=65535\nCompactPDO=0xFF\n";
        assert_eq!(crate::parse(text).description.objects.len(), 1024);
        for text in [
            "NrOfRXPDO=-1\nCompactPDO=1\n",
            "NrOfRXPDO=4\nCompactPDO=0\n",
            "CompactPDO=1\n",
        ] {
            let text = format!("[DeviceInfo]\n{text}");
            assert!(crate::parse(&text).description.objects.is_empty());
        }
    }
}
