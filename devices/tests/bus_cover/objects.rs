//! Compares the dictionaries with the tables of manual 000, chapters 4.4.1 and 4.4.2.

use od_devices::{DEVICES, find};
use odkit::{Access, DataType, Group, Literal};

use crate::models::{MODELS, Model};

/// Index, sub-index, type, access, default, EEPROM. EEPROM: the group of 1010h that saves
/// it; `F` is factory data, which 1011h does not change (MANUALS.md C-GX-10, C-GX-28).
///
/// A default in braces is a field of [`MODELS`], which differs between devices.
const OBJECTS: &str = "
1000 00 U32 ro {device_type} -
1001 00 U8  ro 00                -
1003 00 U8  rw 00                -
1003 01 U32 ro 00000000          -
1003 02 U32 ro 00000000          -
1003 03 U32 ro 00000000          -
1003 04 U32 ro 00000000          -
1003 05 U32 ro 00000000          -
1003 06 U32 ro 00000000          -
1003 07 U32 ro 00000000          -
1003 08 U32 ro 00000000          -
1005 00 U32 rw 80                C
1008 00 STR ro {name}            F
1009 00 STR ro 1.00              -
100A 00 STR ro 1.00              -
100C 00 U16 rw 0                 C
100D 00 U8  rw 0                 C
1010 00 U8  ro 4                 -
1010 01 U32 rw 1                 -
1010 02 U32 rw 1                 -
1010 03 U32 rw 1                 -
1010 04 U32 rw 1                 -
1011 00 U8  ro 4                 -
1011 01 U32 rw 1                 -
1011 02 U32 rw 1                 -
1011 03 U32 rw 1                 -
1011 04 U32 rw 1                 -
1014 00 U32 rw $NODEID+80        C
1016 00 U8  ro 1                 -
1016 01 U32 rw 10000             C
1017 00 U16 rw 0                 C
1018 00 U8  ro 4                 -
1018 01 U32 ro EC                F
1018 02 U32 ro {product_code}    F
1018 03 U32 ro 00010000          -
1018 04 U32 ro 1                 F
1029 00 U8  ro 1                 -
1029 01 U8  rw 1                 C
1800 00 U8  ro 5                 -
1800 01 U32 rw $NODEID+180       C
1800 02 U8  rw FE                C
1800 05 U16 rw 203               C
1801 00 U8  ro 5                 -
1801 01 U32 rw $NODEID+280       C
1801 02 U8  rw 2                 C
1801 05 U16 rw 100               C
1A00 00 U8  ro 1                 -
1A00 01 U32 ro 60040020          -
1A01 00 U8  ro 1                 -
1A01 01 U32 ro 60040020          -
2100 00 U8  rw 2                 M
2101 00 U8  rw 1                 M
2110 00 U32 rw 8                 M
2201 00 U8  ro 3                 -
2201 01 U32 ro 0                 M
2201 02 U32 ro 0                 M
2201 03 U32 ro 0                 M
2300 00 U8  ro 8                 -
2300 01 U16 rw 0                 M
2300 02 U16 rw 0                 M
2300 03 U16 rw 0                 M
2300 04 U16 rw 0                 M
2300 05 U16 rw 0                 M
2300 06 U16 rw 0                 M
2300 07 U16 rw 0                 M
2300 08 U16 rw 0                 M
2800 00 U8  rw 0                 M
2801 00 U8  rw 0                 M
6000 00 U16 rw 4                 A
6001 00 U32 rw {resolution}      A
6002 00 U32 rw {range}           A
6003 00 U32 rw 0                 A
6004 00 U32 ro 0                 -
6200 00 U16 rw 203               A
6500 00 U16 ro 4                 -
6501 00 U32 ro {resolution}      -
6502 00 U32 ro {range}           -
6503 00 U16 ro 0                 -
6504 00 U16 ro 1                 -
6505 00 U16 ro 0                 -
6506 00 U16 ro {warnings}        -
6507 00 U32 ro 01000201          -
6508 00 U32 ro 0                 -
6509 00 U32 ro 0                 A
650B 00 U32 ro 1                 F
";

/// [`OBJECTS`] for one device.
fn objects(model: &Model) -> String {
    [
        ("{name}", model.name.to_string()),
        ("{device_type}", format!("{:X}", model.device_type)),
        ("{product_code}", format!("{:X}", model.product_code)),
        ("{resolution}", format!("{:X}", model.resolution)),
        ("{range}", format!("{:X}", model.range)),
        ("{warnings}", format!("{:X}", model.warnings)),
    ]
    .iter()
    .fold(OBJECTS.to_string(), |text, (cell, value)| {
        text.replace(cell, value)
    })
}

#[test]
fn every_object_of_the_table_and_no_other() {
    for model in &MODELS {
        let device = model.id();
        let dictionary = find(&device).unwrap().dictionary;
        let objects = objects(model);
        let rows: Vec<Vec<&str>> = objects
            .lines()
            .filter(|line| !line.is_empty())
            .map(|line| line.split_whitespace().collect())
            .collect();
        assert_eq!(rows.len(), dictionary.entries().len(), "{device}");
        for (row, entry) in rows.iter().zip(dictionary.entries()) {
            let [index, sub, data_type, access, default, eeprom] = row[..] else {
                panic!("{row:?}");
            };
            let what = format!("{device} {index}:{sub}");
            let hex = |text: &str| u64::from_str_radix(text, 16).unwrap();
            assert_eq!(u64::from(entry.address.index), hex(index), "{what}");
            assert_eq!(u64::from(entry.address.sub), hex(sub), "{what}");
            let (expected_type, expected_access) = (
                match data_type {
                    "U8" => DataType::Unsigned8,
                    "U16" => DataType::Unsigned16,
                    "U32" => DataType::Unsigned32,
                    _ => DataType::VisibleString,
                },
                if access == "rw" {
                    Access::Rw
                } else {
                    Access::Ro
                },
            );
            assert_eq!(entry.data_type, expected_type, "{what}");
            assert_eq!(entry.access, expected_access, "{what}");
            match entry.default {
                Literal::Text(range) => assert_eq!(dictionary.text(range), default, "{what}"),
                Literal::NodeId(offset) => {
                    assert_eq!(format!("$NODEID+{offset:X}"), default, "{what}");
                }
                Literal::Unsigned(value) => assert_eq!(value, hex(default), "{what}"),
                other => panic!("{what}: {other:?}"),
            }
            let group = match eeprom {
                "C" => Group::Communication,
                "A" => Group::Application,
                "M" => Group::Manufacturer,
                _ => Group::None,
            };
            assert_eq!(entry.group, group, "{what}");
            assert_eq!(entry.mappable, index == "6004", "{what}");
        }
    }
}

#[test]
fn limits_are_those_of_the_tables() {
    for model in &MODELS {
        let dictionary = find(&model.id()).unwrap().dictionary;
        let limits: Vec<_> = dictionary
            .entries()
            .iter()
            .filter(|entry| (entry.low, entry.high) != (Literal::None, Literal::None))
            .map(|entry| {
                let (low, high) = (entry.low.integer(1), entry.high.integer(1));
                (entry.address.index, low.unwrap(), high.unwrap())
            })
            .collect();
        let (resolution, range) = (model.resolution.into(), model.range.into());
        assert_eq!(
            limits,
            [
                (0x2101, 1, 127),
                (0x6001, 1, resolution),
                (0x6002, 1, range)
            ],
            "{}",
            model.name
        );
    }
}

#[test]
fn the_sensor_matches_6501h_and_6502h() {
    for model in &MODELS {
        let kind = find(&model.id()).unwrap();
        assert_eq!(kind.title, format!("{}, {}", model.name, model.family));
        let sensor = kind.encoder().unwrap().sensor_of(kind.dictionary);
        assert_eq!(
            (sensor.steps, sensor.turns, sensor.range()),
            (model.resolution, model.turns, model.range.into()),
            "{}",
            model.name
        );
    }
}

/// C-GX-30: only the name distinguishes an activo from a multivoPlus.
#[test]
fn an_activo_differs_from_a_multivo_plus_in_its_name_only() {
    for (activo, plus) in [("gdmm", "gbmm"), ("gdam", "gbam")] {
        let [activo, plus] = [activo, plus].map(|name| find(name).unwrap().dictionary);
        for (one, other) in activo.entries().iter().zip(plus.entries()) {
            let same = match (one.default, other.default) {
                (Literal::Text(a), Literal::Text(b)) => activo.text(a) == plus.text(b),
                (a, b) => a == b,
            };
            let limits = (one.low, one.high) == (other.low, other.high);
            assert_eq!(one.address, other.address);
            assert_eq!(
                same && limits,
                one.address.index != 0x1008,
                "{}",
                one.address
            );
        }
    }
}

#[test]
fn names_are_unique_and_found_in_any_case() {
    for kind in DEVICES {
        let found = find(&kind.name.to_uppercase()).unwrap();
        assert_eq!(found.title, kind.title);
        assert!(
            kind.name
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        );
    }
    assert!(find("gxm").is_none());
}
