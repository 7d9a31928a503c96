//! Sequence numbers, versions, and room.

use super::*;

/// A bank of version 1 of the layout with one record, 6003h = 7.
fn version_1() -> Vec<u8> {
    let mut bytes = b"\x69odk\x01\0\0\0\x01\0\0\0\x09\0\0\0".to_vec();
    let record = [0x03, 0x60, 0, 4, 0, 7, 0, 0, 0];
    let mut crc = crate::storage::crc::Crc32::new();
    crc.update(&bytes[4..]);
    crc.update(&record);
    bytes.extend(crc.finish().to_le_bytes());
    bytes.extend(record);
    bytes
}

#[test]
fn the_set_of_another_device_or_version_is_not_loaded_and_stays() {
    let with_identity = |product| {
        let mut description = Description::default();
        let number = |target, name, value| {
            let edit = Edit::add(target).name(name).access(Access::Ro);
            edit.data_type(DataType::Unsigned32)
                .default(Raw::Integer(value))
        };
        let edits = [
            Edit::add(Target::object(0x1018))
                .name("Identity")
                .code(od_model::ObjectCode::Record),
            number(Target::member(0x1018, 1), "Vendor-ID", 0xEC),
            number(Target::member(0x1018, 2), "Product code", product),
            number(Target::object(0x6003), "Preset", 1)
                .access(Access::Rw)
                .save(od_model::Group::Application),
            number(Target::object(0x2201), "Hours", 0).save(od_model::Group::Manufacturer),
        ];
        for edit in edits {
            let findings = patch::apply(&mut description, &[edit]);
            assert!(findings.is_empty(), "{findings:?}");
        }
        Bench::new(Tables::new(&description))
    };
    let (mut one, mut other) = (with_identity(10), with_identity(11));
    let mut memory = storage();
    one.store()
        .set_unsigned(od_model::Address::new(0x6003, 0), 7);
    save(&mut memory, &one.store(), STORE, 1).unwrap();
    let mut old = vec![0xFF; memory.bytes().len()];
    let version_1 = version_1();
    old[..version_1.len()].copy_from_slice(&version_1);
    for mut memory in [memory, Memory::new(old)] {
        let before = memory.bytes().to_vec();
        assert_eq!(other.start(&mut memory), Loaded::Foreign);
        assert_eq!(other.store().unsigned(0x6003, 0), 1, "the default");
        // The device itself does not write over it; a master may.
        let result = save(&mut memory, &other.store(), STORE, 0);
        assert_eq!(result, Err(StorageError::Foreign));
        assert_eq!(memory.bytes(), before);
        save(&mut memory, &other.store(), STORE, 1).unwrap();
        other.start(&mut memory);
        save(&mut memory, &other.store(), STORE, 1).unwrap();
        assert_eq!(other.start(&mut memory), Loaded::Complete);
    }
}

#[test]
fn too_little_room_is_an_error_before_anything_is_written() {
    let mut bench = Bench::new(device());
    assert_eq!(bench.start(&mut crate::storage::NoStorage), Loaded::Blank);
    assert_eq!(
        save(&mut crate::storage::NoStorage, &bench.store(), STORE, 1),
        Err(StorageError::Full)
    );
    assert_eq!(
        erase(&mut crate::storage::NoStorage, &bench.store(), STORE, 1),
        Ok(())
    );
    for len in 0..120 {
        let mut memory = Memory::new(vec![0xFF; len]);
        if save(&mut memory, &bench.store(), STORE, 1) == Err(StorageError::Full) {
            assert!(memory.bytes().iter().all(|byte| *byte == 0xFF));
        }
        assert!(matches!(
            bench.start(&mut memory),
            Loaded::Blank | Loaded::Complete
        ));
    }
}

#[test]
fn a_record_without_an_object_stays_if_it_just_fits() {
    use Access::Rw;
    let object = |index| (index, DataType::Unsigned32, Rw, Raw::Integer(1));
    let mut old = Bench::new(tables(&[object(0x2300), object(0x2400)]));
    let mut memory = Memory::new(vec![0xFF; capacity_needed(&old.tables.dictionary())]);
    let removed = od_model::Address::new(0x2400, 0);
    old.store().set_unsigned(removed, 77);
    save(&mut memory, &old.store(), STORE, 1).unwrap();
    let mut new = Bench::new(tables(&[object(0x2300)]));
    assert_eq!(new.start(&mut memory), Loaded::Partial { skipped: 1 });
    save(&mut memory, &new.store(), STORE, 1).unwrap();
    assert_eq!(old.start(&mut memory), Loaded::Complete);
    assert_eq!(old.store().unsigned(0x2400, 0), 77);
}

#[test]
fn a_value_above_the_greatest_length_is_an_error() {
    for (len, result) in [
        (MAX_VALUE, Ok(())),
        (MAX_VALUE + 1, Err(StorageError::Full)),
    ] {
        let text = Raw::Text("x".repeat(len));
        let text = (0x2300, DataType::VisibleString, Access::Rw, text);
        let mut bench = Bench::new(tables(&[text]));
        let mut memory = Memory::new(vec![0xFF; capacity_needed(&bench.tables.dictionary())]);
        assert_eq!(save(&mut memory, &bench.store(), STORE, 1), result, "{len}");
        let is_blank = memory.bytes().iter().all(|byte| *byte == 0xFF);
        assert_eq!(is_blank, result.is_err(), "{len}");
    }
}
