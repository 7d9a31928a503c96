//! Fastscan: one slave, several slaves, none; slaves that follow CiA 305 exactly, and nodes of
//! `od-runtime`.

use crate::support::bus::{Bus, peer};
use crate::support::slave::Slave;
use crate::support::{at, frame};
use od_client::Error;
use od_client::lss::{Answer, Identity, Master, Options, Part, Task};
use od_client::{Client, Event, NodeId};

const IDENTITY: Identity = Identity {
    vendor: 0xEC,
    product: 0x0A,
    revision: 0x0001_0000,
    serial: 0x1234,
};

fn begun(task: Task) -> Master {
    let mut master = Master::new(Options::DEFAULT);
    assert_eq!(master.begin(task), Ok(()));
    master
}

/// Slaves on a bus that respond to each request, one after the other, `delay` ms after it.
fn run(master: &mut Master, slaves: &mut [Slave], delay: u64) -> (Result<Answer, Error>, u64) {
    let mut now = 0;
    for _ in 0..1000 {
        while let Some(request) = master.poll_transmit(at(now)) {
            let answers = slaves.iter_mut().filter_map(|slave| slave.handle(&request));
            for (turn, answer) in (0..).zip(answers.collect::<Vec<_>>()) {
                master.handle_frame(at(now + delay + turn), &answer);
            }
        }
        if let Some(answer) = master.poll_answer() {
            return (answer, now);
        }
        now = master.poll_timeout().expect("a deadline").as_micros() / 1000;
        master.handle_timeout(at(now));
    }
    panic!("no end");
}

fn scan(slaves: &mut [Slave]) -> (Result<Answer, Error>, u64) {
    run(&mut begun(Task::Fastscan), slaves, 2)
}

#[test]
fn fastscan_finds_any_lss_address() {
    for parts in [
        IDENTITY.parts(),
        [0; 4],
        [u32::MAX; 4],
        [1, 0x8000_0000, 0x5555_5555, 0xAAAA_AAAA],
    ] {
        let mut slaves = [Slave::new(parts)];
        let (answer, millis) = scan(&mut slaves);
        let identity = Identity::new(parts);
        assert_eq!(answer, Ok(Answer::Found(Some(identity))));
        assert_eq!(identity.parts(), parts);
        assert!(slaves[0].configuration);
        // 2 ms for the response and 10 ms for other slaves; 50 ms for each bit that is 1.
        let ones: u32 = parts.iter().map(|part| part.count_ones()).sum();
        let steps = 1 + 4 * 33;
        assert_eq!(millis, u64::from((steps - ones) * 12 + ones * 50));
    }
}

#[test]
fn the_first_frames_of_a_scan() {
    let mut master = begun(Task::Fastscan);
    let mut sent = Vec::new();
    for step in 0..36 {
        let request = master.poll_transmit(at(step * 50)).expect("a step");
        assert_eq!(master.poll_transmit(at(step * 50)), None, "one at a time");
        sent.push(request.to_string());
        assert_eq!(master.poll_timeout(), Some(at(step * 50 + 50)));
        if step == 0 || step == 33 {
            master.handle_frame(at(step * 50 + 40), &frame("7E4#4F"));
        }
        master.handle_timeout(at(step * 50 + 50));
    }
    assert_eq!(sent[0], "7E5#5100000000800000");
    assert_eq!(sent[1], "7E5#51000000001F0000");
    assert_eq!(sent[2], "7E5#51000000801E0000");
    assert_eq!(sent[32], "7E5#51FEFFFFFF000000");
    assert_eq!(
        sent[33], "7E5#51FFFFFFFF000001",
        "the vendor-ID is confirmed"
    );
    assert_eq!(sent[34], "7E5#51000000001F0101");
    assert_eq!(sent[35], "7E5#51000000801E0101");
}

#[test]
fn a_bus_without_slaves_has_nothing_to_find() {
    assert_eq!(scan(&mut []), (Ok(Answer::Found(None)), 50));
}

#[test]
fn a_slave_that_leaves_during_the_scan_is_an_error() {
    let mut master = begun(Task::Fastscan);
    let mut slave = [Slave::new(IDENTITY.parts())];
    for _ in 0..20 {
        let request = master.poll_transmit(at(0)).expect("a step");
        if let Some(answer) = slave[0].handle(&request) {
            master.handle_frame(at(0), &answer);
        }
        master.handle_timeout(master.poll_timeout().expect("a deadline"));
    }
    let (answer, _) = run(&mut master, &mut [], 0);
    assert_eq!(answer, Err(Error::ScanFailed));
}

#[test]
fn several_slaves_are_found_one_after_the_other() {
    let mut slaves: Vec<_> = [0x1234, 0x1235, 0x9234, 0x0000, 0xFFFF_FFFF]
        .map(|serial| Slave::new([0xEC, 0x0A, 0x0001_0000, serial]))
        .into();
    let mut found = Vec::new();
    for node in (1..=127).map_while(NodeId::new) {
        let (answer, _) = scan(&mut slaves);
        let Ok(Answer::Found(Some(identity))) = answer else {
            assert_eq!(answer, Ok(Answer::Found(None)));
            break;
        };
        found.push(identity.serial);
        let mut configure = begun(Task::ConfigureNodeId(Some(node)));
        assert_eq!(run(&mut configure, &mut slaves, 2).0, Ok(Answer::Done));
        let mut switch = begun(Task::SwitchGlobal {
            configuration: false,
        });
        assert_eq!(run(&mut switch, &mut slaves, 2).0, Ok(Answer::Done));
    }
    assert_eq!(found, [0, 0x1234, 0x1235, 0x9234, 0xFFFF_FFFF]);
    let mut ids: Vec<_> = slaves.iter().map(|slave| slave.node_id).collect();
    ids.sort();
    assert_eq!(ids, [1, 2, 3, 4, 5]);
}

/// Nodes of `od-runtime`, all with node ID 1: first all LSS addresses, then a node ID for each.
#[test]
fn nodes_with_the_same_node_id_are_told_apart() {
    let serials = [7, 6, 0x8000_0000];
    let peers = serials.map(|serial| peer(1, [0xEC, 0x0A, 1, serial]));
    let mut bus = Bus::new(Client::new(), peers.into());
    let mut found = Vec::new();
    loop {
        bus.client.lss(Task::Fastscan);
        let [Event::Lss(_, Ok(Answer::Found(identity)))] = bus.run()[..] else {
            panic!("a scan");
        };
        let Some(identity) = identity else { break };
        found.push(identity);
    }
    let wanted = [6, 7, 0x8000_0000].map(|serial| Identity {
        product: 0x0A,
        revision: 1,
        vendor: 0xEC,
        serial,
    });
    assert_eq!(found, wanted);
    let waiting = Task::SwitchGlobal {
        configuration: false,
    };
    for (raw, identity) in (10..).zip(found) {
        bus.client.lss(waiting);
        bus.client.lss(Task::SwitchSelective(identity));
        bus.client.lss(Task::ConfigureNodeId(NodeId::new(raw)));
        bus.client.lss(Task::Store);
        bus.client.lss(Task::Inquire(Part::Serial));
        bus.client.lss(Task::InquireNodeId);
        let answers: Vec<_> = bus
            .run()
            .into_iter()
            .map(|event| match event {
                Event::Lss(_, Ok(answer)) => answer,
                other => panic!("{other:?}"),
            })
            .collect();
        let wanted = [
            Answer::Done,
            Answer::Done,
            Answer::Done,
            Answer::Done,
            Answer::Number(identity.serial),
            Answer::NodeId(NodeId::new(raw)),
        ];
        assert_eq!(answers, wanted);
    }
    bus.client.lss(waiting);
    bus.client.nmt(None, od_client::nmt::Command::ResetNode);
    let mut booted: Vec<_> = bus
        .run()
        .into_iter()
        .filter_map(|event| match event {
            Event::BootUp(node) => Some(node.raw()),
            _ => None,
        })
        .collect();
    booted.sort();
    assert_eq!(booted, [10, 11, 12]);
}
