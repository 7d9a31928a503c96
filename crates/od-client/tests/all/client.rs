//! Jobs that wait for each other, jobs side by side, and events of the bus.

use crate::support::bus::{Bus, peer};
use crate::support::{OBJECT, at, frame, pattern};
use od_client::Error;
use od_client::emcy::Emcy;
use od_client::lss::{self, Answer, Task};
use od_client::nmt::{Command, State};
use od_client::sdo::Options;
use od_client::{CanId, Client, Duration, Event, Frame, NodeId};
use od_model::Address;

fn node(raw: u8) -> NodeId {
    NodeId::new(raw).expect("a node ID")
}

/// All frames that are sent.
fn out(client: &mut Client, millis: u64) -> Vec<String> {
    let frames = core::iter::from_fn(|| client.poll_transmit(at(millis)));
    frames.map(|frame| frame.to_string()).collect()
}

/// The boot-up message of node 1.
fn booted() -> Frame {
    Frame::new(CanId::standard(0x701), &[0]).expect("a frame")
}

fn events(client: &mut Client) -> Vec<Event> {
    core::iter::from_fn(|| client.poll_event()).collect()
}

#[test]
fn jobs_of_one_node_wait_and_jobs_of_several_nodes_run_at_the_same_time() {
    let mut client = Client::new();
    let first = client.read(node(1), Address::new(0x1000, 0));
    let second = client.write(node(1), Address::new(0x2000, 0), &[1]);
    let other = client.read(node(2), Address::new(0x1000, 0));
    assert!(first < second && second < other);
    assert_eq!([first, second, other].map(|job| job.number()), [1, 2, 3]);
    let mut sent = out(&mut client, 0);
    sent.sort();
    assert_eq!(sent, ["601#4000100000000000", "602#4000100000000000"]);
    client.handle_frame(at(1), &frame("582#4F00100007"));
    assert_eq!(events(&mut client), [Event::Read(other, Ok(vec![7]))]);
    assert!(out(&mut client, 1).is_empty());
    client.handle_frame(at(2), &frame("581#4F00100008"));
    assert_eq!(events(&mut client), [Event::Read(first, Ok(vec![8]))]);
    assert_eq!(out(&mut client, 2), ["601#2F00200001000000"]);
    client.handle_frame(at(3), &frame("581#60002000"));
    assert_eq!(events(&mut client), [Event::Written(second, Ok(()))]);
    assert_eq!(client.poll_timeout(), None);
}

/// A node forgets its transfers when it boots (CiA 301, 7.3.2.2.1): it does not respond, or aborts what it does not know.
#[test]
fn a_node_that_boots_during_a_transfer_is_not_silent() {
    for (last, sent) in [
        (None, "601#8003200000000405"),
        (Some("581#80000000 01000405"), ""),
        (Some("581#80032000 00000305"), ""),
    ] {
        let mut client = Client::new();
        let job = client.read(node(1), OBJECT);
        out(&mut client, 0);
        client.handle_frame(at(1), &frame("581#4103200014000000"));
        out(&mut client, 1);
        client.handle_frame(at(2), &booted());
        match last {
            Some(last) => client.handle_frame(at(3), &frame(&last.replace(' ', ""))),
            None => client.handle_timeout(at(1001)),
        }
        let read = Event::Read(job, Err(Error::Booted));
        let all = events(&mut client);
        assert!(all.contains(&read), "{last:?}: {all:?}");
        assert_eq!(out(&mut client, 1001).concat(), sent, "{last:?}");
        // It has served its requests since then.
        let next = client.read(node(1), OBJECT);
        out(&mut client, 1002);
        client.handle_timeout(at(2002));
        let read = Event::Read(next, Err(Error::Silent));
        assert_eq!(events(&mut client), [read], "{last:?}");
    }
    // Another abort is the answer of the node that has booted.
    let mut client = Client::new();
    let job = client.read(node(1), OBJECT);
    out(&mut client, 0);
    client.handle_frame(at(1), &booted());
    client.handle_frame(at(2), &frame("581#8003200000000206"));
    let read = Event::Read(job, Err(Error::Abort(0x0602_0000)));
    assert!(events(&mut client).contains(&read));
}

#[test]
fn the_next_job_begins_after_one_that_failed() {
    let mut client = Client::new();
    let silent = client.read(node(1), OBJECT);
    let wrong = client.read(node(1), OBJECT);
    let good = client.read(node(1), OBJECT);
    assert_eq!(out(&mut client, 0).len(), 1);
    assert_eq!(client.poll_timeout(), Some(at(1000)));
    client.handle_timeout(at(1000));
    assert_eq!(
        events(&mut client),
        [Event::Read(silent, Err(Error::Silent))]
    );
    let sent = out(&mut client, 1000);
    assert_eq!(sent, ["601#8003200000000405", "601#4003200000000000"]);
    client.handle_frame(at(1001), &frame("581#4F04200001"));
    let Some(Event::Read(job, Err(Error::OutOfTurn { .. }))) = client.poll_event() else {
        panic!("an answer for another object");
    };
    assert_eq!(job, wrong);
    let sent = out(&mut client, 1001);
    assert_eq!(sent, ["601#8003200001000405", "601#4003200000000000"]);
    client.handle_frame(at(1002), &frame("581#4F03200001"));
    assert_eq!(events(&mut client), [Event::Read(good, Ok(vec![1]))]);
}

#[test]
fn block_downloads_take_turns() {
    let mut bus = Bus::new(
        Client::new(),
        vec![peer(1, [1, 2, 3, 4]), peer(2, [1, 2, 3, 5])],
    );
    let value = pattern(500);
    let jobs = [1, 2].map(|raw| bus.client.write(node(raw), OBJECT, &value));
    let wanted = jobs.map(|job| Event::Written(job, Ok(())));
    let mut events = bus.run();
    events.sort_by_key(|event| matches!(event, Event::Written(job, _) if *job == jobs[1]));
    assert_eq!(events, wanted);
    let segments = |text: &&String| text.starts_with("60") && text.as_bytes()[4] < b'8';
    let ids: Vec<_> = bus
        .frames
        .iter()
        .filter(segments)
        .map(|text| &text[..3])
        .collect();
    assert!(ids.len() > 100);
    assert!(ids.windows(2).all(|pair| pair[0] != pair[1]), "{ids:?}");
}

#[test]
fn options_apply_to_every_transfer() {
    let mut options = Options::SEGMENTED;
    options.limit = 8;
    options.timeout = Duration::from_millis(50);
    let mut client = Client::with(options, lss::Options::DEFAULT);
    let job = client.read(node(1), OBJECT);
    assert_eq!(out(&mut client, 0).len(), 1);
    assert_eq!(client.poll_timeout(), Some(at(50)));
    client.handle_frame(at(1), &frame("581#4103200009"));
    assert_eq!(events(&mut client), [Event::Read(job, Err(Error::TooLong))]);
    assert_eq!(out(&mut client, 1), ["601#8003200005000405"]);
    client.write(node(1), OBJECT, &[0; 1000]);
    assert_eq!(out(&mut client, 1), ["601#21032000E8030000"]);
}

#[test]
fn block_transfers_are_tried_again_after_a_boot_up() {
    let mut client = Client::new();
    let value = pattern(100);
    let refuse = |client: &mut Client| {
        client.write(node(1), OBJECT, &value);
        let sent = out(client, 0);
        client.handle_frame(at(0), &frame("581#8003200001000405"));
        client.handle_frame(at(0), &frame("581#8003200000000008"));
        sent
    };
    assert_eq!(refuse(&mut client), ["601#C603200064000000"]);
    assert_eq!(refuse(&mut client), ["601#2103200064000000"]);
    for other in [Frame::standard(0x701, &[5]), Frame::standard(0x702, &[0])] {
        client.handle_frame(at(0), &other);
        assert_eq!(refuse(&mut client), ["601#2103200064000000"], "{other}");
    }
    client.handle_frame(at(0), &Frame::standard(0x701, &[0]));
    assert_eq!(refuse(&mut client), ["601#C603200064000000"]);
}

#[test]
fn cancelled_jobs_have_no_event() {
    let mut client = Client::new();
    let active = client.write(node(1), OBJECT, &[1]);
    let waiting = client.read(node(1), OBJECT);
    let last = client.read(node(1), Address::new(0x1000, 0));
    out(&mut client, 0);
    assert!(client.cancel(at(0), waiting));
    assert!(!client.cancel(at(0), waiting));
    assert!(client.cancel(at(0), active));
    assert!(!client.cancel(at(0), active));
    let sent = out(&mut client, 0);
    assert_eq!(sent, ["601#8003200000000008", "601#4000100000000000"]);
    client.handle_frame(at(1), &frame("581#4F00100007"));
    assert_eq!(events(&mut client), [Event::Read(last, Ok(vec![7]))]);
    // A read that was not sent yet needs no abort.
    let unsent = client.read(node(1), OBJECT);
    assert!(client.cancel(at(1), unsent));
    assert!(out(&mut client, 1).is_empty() && client.poll_timeout().is_none());
    let read = client.read(node(1), OBJECT);
    out(&mut client, 2);
    assert!(client.cancel(at(2), read));
    assert_eq!(out(&mut client, 2), ["601#8003200000000008"]);
}

#[test]
fn cancelled_lss_services_make_room_for_the_next() {
    let mut client = Client::new();
    let first = client.lss(Task::InquireNodeId);
    let second = client.lss(Task::Store);
    let third = client.lss(Task::IdentifyNonConfigured);
    assert_eq!(out(&mut client, 0), ["7E5#5E00000000000000"]);
    assert!(client.cancel(at(0), second) && client.cancel(at(0), first));
    assert!(!client.cancel(at(0), first) && !client.cancel(at(0), second));
    client.handle_frame(at(0), &frame("7E4#5E01"));
    assert_eq!(out(&mut client, 0), ["7E5#4C00000000000000"]);
    client.handle_frame(at(1), &frame("7E4#50"));
    assert_eq!(client.poll_timeout(), Some(at(11)));
    client.handle_timeout(at(11));
    assert_eq!(
        events(&mut client),
        [Event::Lss(third, Ok(Answer::Exists(true)))]
    );
}

#[test]
fn lss_services_run_one_after_the_other() {
    let mut client = Client::new();
    let switch = client.lss(Task::SwitchGlobal {
        configuration: true,
    });
    let inquire = client.lss(Task::InquireNodeId);
    let sent = out(&mut client, 0);
    assert_eq!(sent, ["7E5#0401000000000000", "7E5#5E00000000000000"]);
    assert_eq!(events(&mut client), [Event::Lss(switch, Ok(Answer::Done))]);
    assert_eq!(client.poll_timeout(), Some(at(1000)));
    client.handle_frame(at(5), &frame("7E4#5E07"));
    let wanted = Event::Lss(inquire, Ok(Answer::NodeId(Some(node(7)))));
    assert_eq!(events(&mut client), [wanted]);
}

#[test]
fn nmt_commands_go_first() {
    let mut client = Client::new();
    client.read(node(1), OBJECT);
    client.nmt(Some(node(5)), Command::Start);
    client.nmt(None, Command::ResetCommunication);
    let sent = out(&mut client, 0);
    assert_eq!(sent, ["000#0105", "000#8200", "601#4003200000000000"]);
}

#[test]
fn nodes_boot_are_lost_and_return() {
    let mut client = Client::new();
    client.watch(node(3), Duration::from_millis(100));
    assert_eq!((client.state(node(3)), client.poll_timeout()), (None, None));
    let beat = |client: &mut Client, millis, text| {
        let frame = Frame::new(CanId::standard(0x703), &crate::support::bytes(text)).unwrap();
        client.handle_frame(at(millis), &frame);
        events(client)
    };
    assert_eq!(beat(&mut client, 0, "00"), [Event::BootUp(node(3))]);
    assert_eq!(client.state(node(3)), Some(State::Initialising));
    assert_eq!(client.poll_timeout(), Some(at(100)));
    let operational = Event::State(node(3), State::Operational);
    assert_eq!(beat(&mut client, 90, "05"), [operational]);
    assert!(beat(&mut client, 100, "05").is_empty());
    client.handle_timeout(at(199));
    assert!(events(&mut client).is_empty());
    client.handle_timeout(at(200));
    assert_eq!(events(&mut client), [Event::Lost(node(3))]);
    assert_eq!((client.state(node(3)), client.poll_timeout()), (None, None));
    assert_eq!(beat(&mut client, 300, "05"), [Event::Back(node(3))]);
    assert_eq!(client.state(node(3)), Some(State::Operational));
    client.unwatch(node(3));
    assert_eq!(client.poll_timeout(), None);
    assert!(beat(&mut client, 900, "05").is_empty());
}

#[test]
fn nodes_that_are_not_monitored_are_reported_too() {
    let mut client = Client::new();
    for (frame, wanted) in [
        (Frame::standard(0x77F, &[0]), Some(Event::BootUp(node(127)))),
        (
            Frame::standard(0x77F, &[4]),
            Some(Event::State(node(127), State::Stopped)),
        ),
        (Frame::standard(0x77F, &[4]), None),
        (
            Frame::standard(0x82, &[0x10, 0x81, 0x11, 1, 2, 3, 4, 5]),
            Some(Event::Emcy(
                node(2),
                Emcy {
                    code: 0x8110,
                    register: 0x11,
                    info: [1, 2, 3, 4, 5],
                },
            )),
        ),
        (Frame::standard(0x700, &[0]), None),
    ] {
        client.handle_frame(at(0), &frame);
        assert_eq!(client.poll_event(), wanted, "{frame}");
    }
    assert_eq!(client.state(node(127)), Some(State::Stopped));
}

#[test]
fn a_full_queue_drops_events_of_the_bus_but_no_end_of_a_job() {
    let mut client = Client::new();
    let job = client.read(node(1), OBJECT);
    out(&mut client, 0);
    for round in 0..1000u16 {
        let [low, high] = round.to_le_bytes();
        client.handle_frame(
            at(0),
            &Frame::standard(0x81, &[low, high, 0, 0, 0, 0, 0, 0]),
        );
    }
    client.handle_frame(at(0), &frame("581#4F03200009"));
    assert_eq!(client.dropped_events(), 1000 - 256);
    let all = events(&mut client);
    assert_eq!(all.len(), 257);
    assert_eq!(all[256], Event::Read(job, Ok(vec![9])));
    let codes = all.iter().filter_map(|event| match event {
        Event::Emcy(_, emcy) => Some(emcy.code),
        _ => None,
    });
    assert!(codes.eq(0..256), "the first ones stay");
    client.handle_frame(at(0), &Frame::standard(0x81, &[0; 8]));
    assert_eq!(
        (events(&mut client).len(), client.dropped_events()),
        (1, 744)
    );
}

#[test]
fn a_real_node_boots_sends_heartbeats_and_is_lost() {
    let mut bus = Bus::one(Client::default());
    let write = bus
        .client
        .write(NodeId::ONE, Address::new(0x1017, 0), &[100, 0]);
    bus.client.watch(NodeId::ONE, Duration::from_millis(150));
    bus.run_until(at(1000));
    assert_eq!(bus.client.state(NodeId::ONE), Some(State::PreOperational));
    bus.client.nmt(Some(NodeId::ONE), Command::Start);
    bus.run_until(at(2000));
    bus.client.nmt(None, Command::ResetNode);
    bus.run_until(at(3000));
    let all = events(&mut bus.client);
    let wanted = [
        Event::Written(write, Ok(())),
        Event::State(NodeId::ONE, State::PreOperational),
        Event::State(NodeId::ONE, State::Operational),
        Event::BootUp(NodeId::ONE),
        // 1017h is 0 again.
        Event::Lost(NodeId::ONE),
    ];
    assert_eq!(all, wanted);
}
