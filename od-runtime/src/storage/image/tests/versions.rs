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
