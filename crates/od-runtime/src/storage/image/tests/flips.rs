//! Flipped bits of an image: which set a start loads, and what it reports.

use super::*;

/// Returns an EEPROM after `saves` saves, and the values after each of them; the first are the
/// defaults.
fn saved(saves: u8) -> (Bench, Memory<Vec<u8>>, Vec<Vec<String>>) {
    let (mut bench, mut memory) = (Bench::new(device()), storage());
    let mut sets = vec![bench.values()];
    for with in 0..saves {
        // The sets have different lengths.
        bench.fill(29 - 5 * with);
        sets.push(bench.values());
        save(&mut memory, &bench.store(), STORE, 1).unwrap();
    }
    (bench, memory, sets)
}

/// Number of the set that a start reports as loaded.
fn said(loaded: Loaded, saves: usize) -> usize {
    match loaded {
        Loaded::Complete | Loaded::Flawed | Loaded::Cut { factory: false } => saves,
        Loaded::Older => saves - 1,
        Loaded::Blank | Loaded::Damaged | Loaded::Cut { factory: true } => 0,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_flipped_bit_anywhere_is_noticed_and_reported() {
    for saves in 0..5 {
        let (mut bench, memory, sets) = saved(saves);
        let (mut lost, saves) = (0, usize::from(saves));
        for bit in 0..memory.bytes().len() * 8 {
            let mut flipped = memory.clone();
            flipped.bytes_mut()[bit / 8] ^= 1 << (bit % 8);
            let loaded = bench.start(&mut flipped);
            let place = format!("bit {} of byte {}, {saves} saves", bit % 8, bit / 8);
            assert!(
                matches!(loaded, Loaded::Flawed | Loaded::Older | Loaded::Damaged),
                "{place}: {loaded:?}"
            );
            assert!(
                saves < 2 || loaded != Loaded::Damaged,
                "{place}: one set is whole"
            );
            assert_eq!(bench.values(), sets[said(loaded, saves)], "{place}");
            lost += usize::from(said(loaded, saves) != saves);
            // The next save is sound, and the one after it removes the rest of the damage.
            bench.fill(99);
            let after = bench.values();
            for _ in 0..2 {
                save(&mut flipped, &bench.store(), STORE, 1).unwrap();
            }
            assert_eq!(bench.start(&mut flipped), Loaded::Complete, "{place}");
            assert_eq!(bench.values(), after);
        }
        assert!(saves == 0 || lost > 8 * 40, "records were hit: {lost}");
    }
}

#[test]
fn two_flipped_bits_never_make_a_mixture() {
    let mut random = 0x2545_F491_4F6C_DD1Du64;
    let mut below = move |end: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % end as u64) as usize
    };
    for saves in 0..4 {
        let (mut bench, memory, sets) = saved(saves);
        let (saves, len) = (usize::from(saves), memory.bytes().len());
        for round in 0..6000 {
            let mut flipped = memory.clone();
            // Only bits of the headers are flipped, where two can matter.
            let places = match round % 3 {
                0 => [below(len), below(len)],
                1 => [below(2) * len / 2 + below(HEADER), below(len)],
                _ => [below(2) * len / 2 + below(2), below(2) * len / 2 + below(2)],
            };
            let bits = places.map(|place| (place, 1u8 << below(8)));
            for (place, bit) in bits {
                flipped.bytes_mut()[place] ^= bit;
            }
            let loaded = bench.start(&mut flipped);
            let claimed = said(loaded, saves);
            assert_eq!(bench.values(), sets[claimed], "{bits:?}: {loaded:?}");
        }
    }
}

#[test]
fn an_image_without_its_end_is_reported() {
    for saves in 0..4 {
        let (mut bench, memory, sets) = saved(saves);
        for len in 0..memory.bytes().len() {
            let mut bytes = memory.bytes().to_vec();
            // `storage::File` reads missing bytes of a file in this way.
            bytes[len..].fill(3);
            let loaded = bench.start(&mut Memory::new(bytes));
            assert!(!matches!(loaded, Loaded::Complete | Loaded::Blank));
            let claimed = said(loaded, saves.into());
            assert_eq!(bench.values(), sets[claimed], "{saves}, {len}: {loaded:?}");
        }
    }
}
