//! Live values that the application has at hand.

use super::*;

#[test]
fn a_number_at_hand_is_uploaded_without_a_refresh() {
    let mut bench = bench(&[], 0);
    for (at_hand, byte, reads) in [(Some(0x1234_5678), 0x78, 0), (None, 1, 1), (Some(9), 9, 1)] {
        bench.live.at_hand = at_hand;
        let before = bench.values.clone();
        call!(bench.handle_frame, Instant::ZERO, &request(0x2001, 0));
        let frame = Frame::standard(0x581, &[0x4F, 1, 0x20, 0, byte, 0, 0, 0]);
        assert_eq!(drain(&mut bench), [frame]);
        assert_eq!(bench.live.reads, reads);
        let changed = before.iter().zip(&bench.values);
        assert_eq!(changed.filter(|(a, b)| a != b).count(), 1, "its own byte");
        assert_eq!(stored(&mut bench), u64::from(byte));
    }
}

#[test]
fn a_number_at_hand_goes_into_a_pdo_without_a_refresh() {
    let mut bench = running(&[1, 1], 0x2001);
    for (at_hand, byte) in [(Some(0x1_07), 7), (Some(8), 8)] {
        bench.live.at_hand = at_hand;
        let reads = bench.live.reads;
        hear(&mut bench, 0x80, &[]);
        let frames = drain(&mut bench);
        assert_eq!(frames.len(), 2);
        assert_eq!(frames[1].data()[0], byte);
        assert_eq!(bench.live.reads, reads);
        assert_eq!(stored(&mut bench), u64::from(byte));
    }
    bench.live.at_hand = None;
    let reads = bench.live.reads;
    hear(&mut bench, 0x80, &[]);
    assert_eq!(drain(&mut bench)[1].data()[0], reads + 1);
}

/// 2001h as the store has it.
fn stored(bench: &mut Bench) -> u64 {
    let dictionary = bench.tables.dictionary();
    let store = Store::new(&dictionary, &mut bench.values, NodeId::ONE);
    store.map_or(0, |store| store.unsigned(0x2001, 0))
}
