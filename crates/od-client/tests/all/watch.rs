//! Boot-up and heartbeat consumer on a table of fixed size.

use od_client::nmt::State;
use od_client::watch::{Event, Full, Watch, parse};
use od_client::{CanId, Duration, Frame, Instant, NodeId};

fn node(raw: u8) -> NodeId {
    NodeId::new(raw).expect("a node ID")
}

fn at(millis: u64) -> Instant {
    Instant::from_millis(millis)
}

fn beat<const N: usize>(watch: &mut Watch<N>, millis: u64, raw: u16, state: u8) {
    watch.handle_frame(at(millis), &Frame::standard(0x700 + raw, &[state]));
}

fn events<const N: usize>(watch: &mut Watch<N>) -> Vec<Event> {
    core::iter::from_fn(|| watch.poll_event()).collect()
}

#[test]
fn a_full_table_is_an_error() {
    let mut watch: Watch<2> = Watch::default();
    assert_eq!(watch.add(node(1), None), Ok(()));
    assert_eq!(watch.add(node(2), Some(Duration::from_millis(9))), Ok(()));
    assert_eq!(watch.add(node(3), None), Err(Full));
    assert_eq!(watch.add(node(2), None), Ok(()), "it has its place");
    assert!(watch.contains(node(1)) && !watch.contains(node(3)));
    watch.remove(node(1));
    assert!(!watch.contains(node(1)) && watch.contains(node(2)));
    assert_eq!(watch.add(node(3), None), Ok(()));
}

#[test]
fn only_watched_nodes_are_reported() {
    let mut watch: Watch<1> = Watch::new();
    assert_eq!(watch.add(node(1), None), Ok(()));
    beat(&mut watch, 0, 2, 5);
    assert!(events(&mut watch).is_empty());
    assert_eq!(watch.state(node(2)), None);
    beat(&mut watch, 0, 1, 5);
    assert_eq!(
        events(&mut watch),
        [Event::State(node(1), State::Operational)]
    );
    assert_eq!(watch.state(node(1)), Some(State::Operational));
    assert_eq!(watch.poll_timeout(), None, "never lost");
    watch.handle_timeout(at(1_000_000));
    assert!(events(&mut watch).is_empty());
}

#[test]
fn the_timeout_is_the_first_deadline_of_all_nodes() {
    let mut watch: Watch<3> = Watch::new();
    for (raw, millis) in [(1, 300), (2, 100), (3, 200)] {
        assert_eq!(
            watch.add(node(raw), Some(Duration::from_millis(millis))),
            Ok(())
        );
        beat(&mut watch, 0, raw.into(), 0x7F);
    }
    assert_eq!(events(&mut watch).len(), 3);
    assert_eq!(watch.poll_timeout(), Some(at(100)));
    watch.handle_timeout(at(250));
    assert_eq!(
        events(&mut watch),
        [Event::Lost(node(2)), Event::Lost(node(3))]
    );
    assert_eq!(watch.poll_timeout(), Some(at(300)));
    watch.handle_timeout(at(260));
    assert!(events(&mut watch).is_empty(), "told once");
}

#[test]
fn events_of_one_kind_do_not_pile_up() {
    let mut watch: Watch<1> = Watch::new();
    assert_eq!(watch.add(node(1), Some(Duration::from_millis(10))), Ok(()));
    for round in 0..1000 {
        let now = round * 100;
        beat(&mut watch, now, 1, 0);
        beat(&mut watch, now, 1, 5);
        beat(&mut watch, now, 1, 4);
        watch.handle_timeout(at(now + 10));
    }
    let wanted = [
        Event::Lost(node(1)),
        Event::Back(node(1)),
        Event::BootUp(node(1)),
        Event::State(node(1), State::Stopped),
    ];
    assert_eq!(events(&mut watch), wanted);
}

#[test]
fn a_boot_up_message_restarts_the_states() {
    let mut watch: Watch<1> = Watch::new();
    assert_eq!(watch.add(node(1), None), Ok(()));
    beat(&mut watch, 0, 1, 5);
    beat(&mut watch, 0, 1, 0);
    assert_eq!(
        events(&mut watch),
        [Event::BootUp(node(1))],
        "the state before it is over"
    );
    beat(&mut watch, 0, 1, 5);
    assert_eq!(
        events(&mut watch),
        [Event::State(node(1), State::Operational)]
    );
}

#[test]
fn a_new_time_applies_from_the_next_heartbeat_on() {
    let mut watch: Watch<1> = Watch::new();
    assert_eq!(watch.add(node(1), Some(Duration::from_millis(10))), Ok(()));
    beat(&mut watch, 0, 1, 5);
    watch.handle_timeout(at(10));
    assert_eq!(watch.add(node(1), Some(Duration::from_millis(50))), Ok(()));
    assert_eq!(watch.poll_timeout(), None);
    events(&mut watch);
    beat(&mut watch, 20, 1, 5);
    assert_eq!(watch.poll_timeout(), Some(at(70)));
    assert!(
        events(&mut watch).is_empty(),
        "what was lost before does not matter"
    );
}

#[test]
fn heartbeats_have_one_byte_and_a_known_state() {
    let told = |frame: &Frame| parse(frame).map(|(node, state)| (node.raw(), state));
    let frame = |id, bytes: &[u8]| Frame::new(CanId::standard(id), bytes).unwrap();
    for (frame, wanted) in [
        (frame(0x701, &[0x00]), Some((1, State::Initialising))),
        (frame(0x77F, &[0x7F]), Some((127, State::PreOperational))),
        // The answer to node guarding, with toggle bit.
        (frame(0x701, &[0x85]), Some((1, State::Operational))),
        (frame(0x701, &[0xFF]), Some((1, State::PreOperational))),
        (frame(0x701, &[0x80]), None),
        (frame(0x701, &[0x06]), None),
        (frame(0x701, &[]), None),
        (frame(0x701, &[5, 0]), None),
        (frame(0x700, &[5]), None),
        (frame(0x780, &[5]), None),
        (frame(0x6FF, &[5]), None),
        (Frame::of(CanId::extended(0x701), &[5]), None),
        (Frame::remote(CanId::standard(0x701), 1).unwrap(), None),
    ] {
        assert_eq!(told(&frame), wanted, "{frame}");
    }
}
