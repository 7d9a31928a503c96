//! Decoding of PDOs by their mapping.

use od_client::pdo::{Field, Mapping, TooShort, bits, decode};
use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Tables, Value};
use od_model::{Address, DataType, ObjectCode};

fn tables(rows: &[(u16, u8, DataType, Option<Value>)]) -> Tables {
    let mut description = Description::default();
    for (index, sub, data_type, default) in rows {
        let mut entry = EntryDescription::new(format!("{index:04X} {sub}"), *data_type);
        entry.default = default.clone().map(Spanned::from);
        let object = description
            .objects
            .entry(*index)
            .or_insert_with(|| ObjectDescription::var(entry.clone()));
        if *sub > 0 {
            object.code = Spanned::from(ObjectCode::Record);
        }
        object.entries.insert(*sub, entry);
    }
    Tables::new(&description)
}

fn device() -> Tables {
    use DataType::*;
    let number = |value: u32| Some(Value::Unsigned(value.into()));
    tables(&[
        (0x1A00, 0, Unsigned8, number(2)),
        (0x1A00, 1, Unsigned32, number(0x6004_0020)),
        (0x1A00, 2, Unsigned32, number(0x6030_0110)),
        (0x1A00, 3, Unsigned32, number(0x1234_5678)),
        (0x1A01, 0, Unsigned8, number(2)),
        (0x1A01, 1, Unsigned32, number(0x6004_0020)),
        (0x1A02, 0, Unsigned8, number(65)),
        (0x1A03, 0, Unsigned8, number(1)),
        (0x1A03, 1, Integer8, Some(Value::Signed(-1))),
        (0x1A04, 0, Unsigned8, number(0)),
        (0x6000, 0, Boolean, None),
        (0x6004, 0, Unsigned32, None),
        (0x6030, 0, Unsigned8, None),
        (0x6030, 1, Integer16, None),
    ])
}

/// Address, first bit, bits and value of each field.
fn fields(mapping: &[u32], data: &[u8]) -> Vec<(Address, u8, u8, u64)> {
    let tables = device();
    let fields = decode(&tables.dictionary(), mapping, data).expect("enough bits");
    assert_eq!(fields.len(), mapping.len());
    let row = |field: Field| (field.address, field.first, field.bits, field.unsigned());
    fields.map(row).collect()
}

#[test]
fn the_default_mapping_of_an_encoder() {
    let tables = device();
    let dictionary = tables.dictionary();
    let mapping = Mapping::of(&dictionary, 0x1A00).expect("a mapping");
    assert_eq!(mapping.entries(), [0x6004_0020, 0x6030_0110]);
    // candump: 181#92950700FEFF
    let data = [0x92, 0x95, 0x07, 0x00, 0xFE, 0xFF];
    let fields = decode(&dictionary, mapping.entries(), &data).expect("48 bits");
    let [position, speed] = fields.collect::<Vec<_>>()[..] else {
        panic!("two fields");
    };
    assert_eq!(
        (position.unsigned(), position.signed()),
        (0x0007_9592, 0x0007_9592)
    );
    assert_eq!(position.data_type(), Some(DataType::Unsigned32));
    assert_eq!(position.bytes()[..position.len()], [0x92, 0x95, 0x07, 0x00]);
    assert_eq!(
        position.entry.map(|entry| entry.address),
        Some(Address::new(0x6004, 0))
    );
    assert_eq!((speed.unsigned(), speed.signed()), (0xFFFE, -2));
    assert_eq!((speed.first, speed.bits, speed.len()), (32, 16, 2));
    assert_eq!(speed.address, Address::new(0x6030, 1));
    assert!(!speed.is_dummy() && !speed.is_empty());
}

#[test]
fn a_mapping_that_is_not_in_the_dictionary_gives_none() {
    let tables = device();
    let of = |index| Mapping::of(&tables.dictionary(), index);
    assert_eq!(of(0x1A05), None, "no such object");
    assert_eq!(of(0x1A01), None, "fewer entries than counted");
    assert_eq!(of(0x1A02), None, "more than 64");
    assert_eq!(of(0x1A03), None, "not a mapping entry");
    assert_eq!(of(0x1A04).map(|mapping| mapping.entries().len()), Some(0));
}

#[test]
fn fields_of_single_bits() {
    let a = |index| Address::new(index, 0);
    let mapping = [
        0x6000_0001,
        0x6001_0003,
        0x0005_0008,
        0x6002_0001,
        0x6004_000B,
    ];
    let wanted = [
        (a(0x6000), 0, 1, 0b1),
        (a(0x6001), 1, 3, 0b101),
        (a(0x0005), 4, 8, 0xDA),
        (a(0x6002), 12, 1, 0b0),
        (a(0x6004), 13, 11, 0b101_0101_0110),
    ];
    assert_eq!(fields(&mapping, &[0xAB, 0xCD, 0xAA]), wanted);
}

#[test]
fn every_position_and_length_is_exact() {
    let data = [0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF];
    let all = u128::from(u64::from_le_bytes(data));
    for first in 0..=64u32 {
        for bits in 0..=64 - first {
            let mapping = [0x2000_0000 | first, 0x2001_0000 | bits];
            let value = (all >> first & ((1 << bits) - 1)) as u64;
            let [(_, at, len, got)] = fields(&mapping, &data)[1..] else {
                panic!("two fields");
            };
            assert_eq!((u32::from(at), u32::from(len), got), (first, bits, value));
        }
    }
}

#[test]
fn the_mapped_length_has_the_sign() {
    let tables = device();
    for (bits, raw, value) in [
        (1, 1u64, -1i64),
        (1, 0, 0),
        (4, 0b0111, 7),
        (4, 0b1000, -8),
        (24, 0x80_0000, -0x80_0000),
        (64, u64::MAX, -1),
        (64, u64::MAX >> 1, i64::MAX),
        (0, 0xFF, 0),
    ] {
        let mapping = [0x6030_0100 | bits];
        let fields = decode(&tables.dictionary(), &mapping, &raw.to_le_bytes());
        let field = fields.expect("64 bits").next().expect("a field");
        assert_eq!(field.signed(), value, "{bits} bits");
        assert_eq!(field.len(), bits.div_ceil(8) as usize);
        assert_eq!(field.is_empty(), bits == 0);
    }
}

#[test]
fn a_dummy_entry_fills_a_gap() {
    let tables = device();
    let mapping = [0x0007_0020, 0x0020_0008, 0x001F_0008, 0x2345_0008];
    let fields = decode(&tables.dictionary(), &mapping, &[0; 7]).expect("56 bits");
    let fields: Vec<_> = fields
        .map(|field| (field.is_dummy(), field.data_type()))
        .collect();
    let wanted = [
        (true, Some(DataType::Unsigned32)),
        (false, Some(DataType::PdoCommunicationParameter)),
        (true, None),
        (false, None),
    ];
    assert_eq!(fields, wanted);
}

#[test]
fn more_data_than_mapped_is_ignored_and_less_is_an_error() {
    assert_eq!(
        fields(&[0x6000_0008], &[1, 2, 3, 4, 5, 6, 7, 8, 9]).len(),
        1
    );
    assert_eq!(fields(&[], &[]), []);
    let tables = device();
    let error = |mapping: &[u32], data: &[u8]| decode(&tables.dictionary(), mapping, data).err();
    let short = |mapped, received| Some(TooShort { mapped, received });
    assert_eq!(error(&[0x6000_0008, 0x6000_0001], &[1]), short(9, 8));
    assert_eq!(error(&[0x6000_0008, 0x6000_0008], &[1, 2]), None);
    assert_eq!(error(&[0x6000_00FF; 3], &[0; 64]), short(765, 64));
    assert_eq!(error(&[0x6000_0041], &[0; 8]), short(65, 64));
}

#[test]
fn bits_of_a_frame_are_a_number() {
    let data = [0x81, 0x32, 0x54, 0x76, 0x98, 0xBA, 0xDC, 0xFE];
    for (len, first, count, value) in [
        (8, 0, 64, Some(0xFEDC_BA98_7654_3281)),
        (8, 4, 8, Some(0x28)),
        (8, 7, 1, Some(1)),
        (8, 63, 1, Some(1)),
        (1, 0, 8, Some(0x81)),
        (1, 1, 8, None), // the data ends before
        (8, 1, 64, None),
        (8, 0, 0, None),
        (8, 0, 65, None),
        (0, 0, 1, None),
    ] {
        assert_eq!(
            bits(&data[..len], first, count),
            value,
            "{len} {first} {count}"
        );
    }
    // Only the first 64 bits of longer data are used.
    assert_eq!(bits(&[0xFF; 9], 60, 5), None);
}
