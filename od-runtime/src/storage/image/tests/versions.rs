//! Sequence numbers, versions, and room.

use super::*;

#[test]
fn sequence_numbers_wrap() {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    bench.fill(1);
    save(&mut memory, &bench.store(), STORE, 1).unwrap();
    let bytes = memory.bytes_mut();
    bytes[8..12].copy_from_slice(&(u32::MAX - 1).to_le_bytes());
    let len = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
    let mut crc = crate::storage::crc::Crc32::new();
    crc.update(&bytes[4..16]);
    crc.update(&bytes[HEADER..HEADER + len]);
    bytes[16..20].copy_from_slice(&crc.finish().to_le_bytes());
    for with in 2..8 {
        bench.fill(with);
        save(&mut memory, &bench.store(), STORE, 1).unwrap();
        assert_eq!(bench.start(&mut memory), Loaded::Complete);
        assert_eq!(bench.store().unsigned(0x6003, 0), u64::from(with));
    }
}

#[test]
fn another_version_is_not_read() {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    bench.fill(1);
    save(&mut memory, &bench.store(), STORE, 1).unwrap();
    memory.bytes_mut()[4] = 2;
    assert_eq!(bench.start(&mut memory), Loaded::Damaged);
    assert_eq!(bench.store().unsigned(0x6003, 0), 0);
    // A save leaves it where it is, as long as there is another bank.
    save(&mut memory, &bench.store(), STORE, 1).unwrap();
    assert_eq!(memory.bytes()[..5], *b"\x69odk\x02");
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
fn a_record_without_an_object_stays_where_it_just_fits() {
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
fn a_value_longer_than_any_that_is_saved_is_an_error() {
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
