//! Ticks of event timers.

use super::*;

#[test]
fn event_timers_tick_without_the_machines() {
    let mut bench = running(&[255, 1], 0x2001);
    let at = Instant::from_millis(10);
    assert_eq!(bench.node.poll_timeout(), Some(at));
    call!(bench.handle_timeout, at);
    assert_eq!(bench.node.machines.pending, pending::FIRST_MARK);
    assert_eq!(bench.node.machines.next, Instant::from_millis(20));
    let sent = call!(bench.poll_transmit, at).map(|frame| frame.id().raw());
    assert_eq!(sent, Some(0x181));
    assert_eq!(call!(bench.poll_transmit, at), None);
    assert_eq!(bench.node.poll_timeout(), Some(Instant::from_millis(20)));
    // What is sent when it changes has to be looked at.
    bench.profile.pdo.event_on_change = true;
    hear(&mut bench, 0, &[0x82, 1]);
    hear(&mut bench, 0, &[1, 1]);
    drain(&mut bench);
    assert!(bench.node.machines.watches_changes);
    call!(bench.handle_timeout, Instant::from_millis(20));
    assert_ne!(bench.node.machines.pending & pending::OTHER, 0);
}

/// CiA 301, chapter 7.5.2.37 (sub-index 05h): the period goes on, and what was missed is not made up for.
#[test]
fn a_host_that_is_late_sends_one_frame_for_all_ticks_it_missed() {
    let mut bench = running(&[255], 0);
    for (now, next) in [(10, 20), (30, 40), (45, 50), (75, 80), (80, 90)] {
        let at = Instant::from_millis(now);
        call!(bench.handle_timeout, at);
        let frames = core::iter::from_fn(|| call!(bench.poll_transmit, at)).count();
        let due = Some(Instant::from_millis(next));
        assert_eq!((frames, bench.node.poll_timeout()), (1, due), "{now}");
    }
    // 1800h:05 counts milliseconds, and more than a second of them, too.
    let period = Frame::standard(0x601, &[0x2B, 0x00, 0x18, 5, 0xD0, 7, 0, 0]);
    call!(bench.handle_frame, Instant::from_millis(80), &period);
    for now in [2080, 4080, 6080] {
        drain(&mut bench);
        let at = Instant::from_millis(now);
        assert_eq!(bench.node.poll_timeout(), Some(at));
        call!(bench.handle_timeout, at);
    }
}

#[test]
fn what_the_inhibit_time_holds_back_is_not_marked() {
    let mut bench = running(&[255, 255], 0x2001);
    let at = Instant::from_millis(10);
    call!(bench.handle_timeout, at);
    assert_eq!(bench.node.machines.pending, pending::FIRST_MARK * 3);
    assert_eq!(bench.node.poll_timeout(), Some(Instant::ZERO));
    // Each of the two is inhibited from now on.
    for pdo in bench.node.machines.tpdos_mut() {
        pdo.inhibit(Instant::from_millis(25));
    }
    let mut sent = drain(&mut bench).into_iter();
    assert_eq!(sent.next().map(|frame| frame.id().raw()), Some(0x181));
    assert_eq!(sent.count(), 1, "both were marked before");
    for pdo in bench.node.machines.tpdos_mut() {
        pdo.inhibit(Instant::from_millis(25));
    }
    call!(bench.handle_timeout, Instant::from_millis(20));
    assert_eq!(bench.node.machines.pending, pending::PDO);
    let at = Instant::from_millis(20);
    assert_eq!(call!(bench.poll_transmit, at), None);
    let due = Instant::from_millis(25);
    assert_eq!(bench.node.poll_timeout(), Some(due));
    assert!(call!(bench.poll_transmit, due).is_some());
}

#[test]
fn a_pdo_that_has_nothing_to_send_calls_nobody_back() {
    let mut bench = running(&[255, 1], 0x2001);
    let (at, due) = (Instant::from_millis(10), Instant::from_millis(15));
    bench.node.machines.tpdos_mut()[0].inhibit(due);
    call!(bench.handle_timeout, at);
    assert_eq!(call!(bench.poll_transmit, at), None);
    assert_eq!(bench.node.poll_timeout(), Some(due));
}

#[test]
fn other_deadlines_have_the_machines_look() {
    let mut bench = running(&[255], 0);
    let producer = Frame::standard(0x601, &[0x2B, 0x17, 0x10, 0, 15, 0, 0, 0]);
    call!(bench.handle_frame, Instant::ZERO, &producer);
    drain(&mut bench);
    let ids = |bench: &mut Bench, at| {
        let at = Instant::from_millis(at);
        assert_eq!(bench.node.poll_timeout(), Some(at));
        call!(bench.handle_timeout, at);
        let frames = core::iter::from_fn(|| call!(bench.poll_transmit, at));
        frames.map(|frame| frame.id().raw()).collect::<Vec<_>>()
    };
    assert_eq!(ids(&mut bench, 10), [0x181]);
    assert_eq!(ids(&mut bench, 15), [0x701]);
    assert_eq!(ids(&mut bench, 20), [0x181]);
    assert_eq!(ids(&mut bench, 30), [0x701, 0x181]);
}
