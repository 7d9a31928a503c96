//! Tests of the marks of SYNC, and of the values that are watched for changes.

use super::*;

#[test]
fn a_tpdo_that_is_off_has_nothing_to_do_at_a_sync() {
    let mut bench = running(&[1, 0, 252], 0x2001);
    assert!(!bench.node.machines.quick.syncs);
    for at in 1..3 {
        let off = Frame::standard(0x601, &[0x23, at - 1, 0x18, 1, 0x81, at, 0, 0x80]);
        call!(bench.handle_frame, Instant::ZERO, &off);
    }
    drain(&mut bench);
    let off = Frame::standard(0x601, &[0x23, 2, 0x18, 1, 0x81, 3, 0, 0x80]);
    call!(bench.handle_frame, Instant::ZERO, &off);
    drain(&mut bench);
    let quick = bench.node.machines.quick;
    assert_eq!((quick.syncs, quick.marks), (true, 0), "all are off");
}

#[test]
fn what_a_sync_marked_is_due_at_once() {
    let mut bench = running(&[255, 255, 1], 0x2001);
    let timer = Instant::from_millis(10);
    assert_eq!(bench.node.poll_timeout(), Some(timer));
    hear(&mut bench, 0x80, &[]);
    assert_eq!(bench.node.poll_timeout(), Some(Instant::ZERO));
    drain(&mut bench);
    assert_eq!(bench.node.poll_timeout(), Some(timer));
}

#[test]
fn live_values_are_watched_where_their_changes_are_sent() {
    let watches = |types: &[u64], others| {
        let mut bench = bench(types, others);
        bench.profile.pdo.event_on_change = true;
        hear(&mut bench, 0, &[0x82, 1]);
        hear(&mut bench, 0, &[1, 1]);
        drain(&mut bench);
        let node = &bench.node.machines;
        let hears_all = node.ear.codes == Ear::EVERYTHING;
        assert_eq!(hears_all, node.watches_live);
        (node.watches_changes, node.watches_live)
    };
    assert_eq!(watches(&[255], 0), (true, false));
    assert_eq!(watches(&[255, 255], 0x2001), (true, true));
    assert_eq!(watches(&[255, 1], 0x2001), (true, false));
    assert_eq!(watches(&[1, 253], 0x2001), (false, false));
}
