//! LSS master: each service by hand, fastscan, and slaves on a bus.

mod support;

use od_client::lss::{Answer, Busy, Identity, LssError, Master, Options, Part, Task};
use od_client::{Client, Event, Frame, NodeId};
use support::bus::{Bus, Peer};
use support::slave::Slave;
use support::{at, frame};

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

fn out(master: &mut Master, millis: u64) -> Vec<String> {
    let frames = core::iter::from_fn(|| master.poll_transmit(at(millis)));
    let text = |frame: Frame| frame.to_string().trim_end_matches('0').into();
    frames.map(text).collect()
}

/// A service that sends these frames, and what this answer makes of it.
#[track_caller]
fn check(task: Task, requests: &[&str], answer: &str, wanted: Result<Answer, LssError>) {
    let mut master = begun(task);
    let requests: Vec<_> = requests.iter().map(|data| format!("7E5#{data}")).collect();
    assert_eq!(out(&mut master, 0), requests);
    assert_eq!((master.poll_answer(), master.is_busy()), (None, true));
    master.handle_frame(at(1), &frame(&format!("7E4#{answer}")));
    assert_eq!(master.poll_answer(), Some(wanted), "{answer}");
    assert_eq!((master.poll_answer(), master.is_busy()), (None, false));
    assert_eq!(
        (master.poll_timeout(), master.poll_transmit(at(1))),
        (None, None)
    );
}

/// The trace of CiA 305 for the services that one slave answers.
#[test]
fn each_service_has_its_frames() {
    check(
        Task::SwitchSelective(IDENTITY),
        &["40EC", "410A", "42000001", "433412"],
        "44",
        Ok(Answer::Done),
    );
    for (part, command, value) in [
        (Part::Vendor, "5A", 0xEC),
        (Part::Product, "5B", 0x0A),
        (Part::Revision, "5C", 0x0001_0000),
        (Part::Serial, "5D", 0x1234_5678),
    ] {
        let bytes: u32 = value;
        let bytes: String = bytes
            .to_le_bytes()
            .map(|byte| format!("{byte:02X}"))
            .concat();
        let value = Ok(Answer::Number(value));
        check(
            Task::Inquire(part),
            &[command],
            &format!("{command}{bytes}"),
            value,
        );
    }
    check(
        Task::InquireNodeId,
        &["5E"],
        "5E7F",
        Ok(Answer::NodeId(NodeId::new(127))),
    );
    check(
        Task::InquireNodeId,
        &["5E"],
        "5EFF",
        Ok(Answer::NodeId(None)),
    );
    check(
        Task::InquireNodeId,
        &["5E"],
        "5E00",
        Ok(Answer::NodeId(None)),
    );
    check(
        Task::ConfigureNodeId(NodeId::new(5)),
        &["1105"],
        "11",
        Ok(Answer::Done),
    );
    check(
        Task::ConfigureNodeId(None),
        &["11FF"],
        "11",
        Ok(Answer::Done),
    );
    let timing = Task::ConfigureBitTiming { table: 0, index: 4 };
    check(timing, &["130004"], "13", Ok(Answer::Done));
    check(Task::Store, &["17"], "17", Ok(Answer::Done));
}

#[test]
fn error_codes_of_the_slave() {
    let refused = |error, specific| Err(LssError::Refused { error, specific });
    check(
        Task::ConfigureNodeId(None),
        &["11FF"],
        "1101",
        refused(1, 0),
    );
    let timing = Task::ConfigureBitTiming { table: 1, index: 9 };
    check(timing, &["130109"], "13FF2A", refused(0xFF, 0x2A));
    check(Task::Store, &["17"], "1702", refused(2, 0));
}

#[test]
fn some_services_have_no_answer() {
    for (task, request) in [
        (
            Task::SwitchGlobal {
                configuration: true,
            },
            "7E5#0401",
        ),
        (
            Task::SwitchGlobal {
                configuration: false,
            },
            "7E5#04",
        ),
        (Task::ActivateBitTiming { delay_ms: 0x1234 }, "7E5#153412"),
    ] {
        let mut master = begun(task);
        assert_eq!(out(&mut master, 0), [request]);
        assert_eq!(master.poll_answer(), Some(Ok(Answer::Done)));
        assert_eq!((master.is_busy(), master.poll_timeout()), (false, None));
    }
}

#[test]
fn identification_is_answered_by_silence_too() {
    let ranges = Task::Identify {
        vendor: 0xEC,
        product: 0x0A,
        revision: [1, 2],
        serial: [3, 4],
    };
    let requests = ["46EC", "470A", "4801", "4902", "4A03", "4B04"];
    for (task, requests, answer) in [
        (ranges, &requests[..], "7E4#4F"),
        (Task::IdentifyNonConfigured, &["4C"], "7E4#50"),
    ] {
        for exists in [true, false] {
            let mut master = begun(task);
            let wanted: Vec<_> = requests.iter().map(|data| format!("7E5#{data}")).collect();
            assert_eq!(out(&mut master, 0), wanted);
            assert_eq!(master.poll_timeout(), Some(at(1000)));
            if exists {
                // Three slaves answer, one after the other.
                for millis in [5, 8, 14] {
                    master.handle_frame(at(millis), &frame(answer));
                    assert_eq!(master.poll_timeout(), Some(at(15)));
                }
            }
            let end = if exists { 15 } else { 1000 };
            master.handle_timeout(at(end - 1));
            assert_eq!(master.poll_answer(), None);
            master.handle_timeout(at(end));
            assert_eq!(master.poll_answer(), Some(Ok(Answer::Exists(exists))));
        }
    }
}

#[test]
fn other_answers_do_not_count() {
    for (task, answers) in [
        (
            Task::Inquire(Part::Vendor),
            &["5B", "5E", "44", "11", "4F", "50"][..],
        ),
        (Task::InquireNodeId, &["5A", "44", "17"]),
        (Task::SwitchSelective(IDENTITY), &["4F", "50", "5A"]),
        (Task::ConfigureNodeId(None), &["13", "17", "44"]),
        (
            Task::ConfigureBitTiming { table: 0, index: 0 },
            &["11", "17"],
        ),
        (Task::Store, &["11", "13"]),
        (Task::IdentifyNonConfigured, &["4F", "44"]),
    ] {
        let mut master = begun(task);
        // Nothing is an answer before the last request is out.
        for answer in ["5A", "5E", "44", "11", "13", "17"] {
            master.handle_frame(at(0), &frame(&format!("7E4#{answer}")));
        }
        assert!(!out(&mut master, 0).is_empty());
        for answer in answers {
            master.handle_frame(at(1), &frame(&format!("7E4#{answer}")));
        }
        master.handle_frame(at(1), &frame("7E5#5A"));
        master.handle_frame(at(1), &Frame::standard(0x7E4, &[0x5A, 0, 0]));
        assert_eq!(
            (master.poll_answer(), master.poll_timeout()),
            (None, Some(at(1000)))
        );
        master.handle_timeout(at(999));
        assert!(master.is_busy());
        master.handle_timeout(at(1000));
        let wanted = match task {
            Task::IdentifyNonConfigured => Ok(Answer::Exists(false)),
            _ => Err(LssError::Silent),
        };
        assert_eq!(master.poll_answer(), Some(wanted));
    }
}

#[test]
fn one_service_at_a_time() {
    let mut master = begun(Task::Store);
    assert_eq!(master.begin(Task::Store), Err(Busy));
    master.cancel();
    assert_eq!(out(&mut master, 0), [""; 0]);
    assert_eq!(master.begin(Task::InquireNodeId), Ok(()));
    assert_eq!(out(&mut master, 0), ["7E5#5E"]);
    master.handle_frame(at(1), &frame("7E4#5E01"));
    assert_eq!(master.begin(Task::Store), Ok(()));
    assert_eq!(
        master.poll_answer(),
        None,
        "what was not taken is forgotten"
    );
}

/// Slaves on a bus that answer each request, one after the other, `delay` ms after it.
fn run(master: &mut Master, slaves: &mut [Slave], delay: u64) -> (Result<Answer, LssError>, u64) {
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

fn scan(slaves: &mut [Slave]) -> (Result<Answer, LssError>, u64) {
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
        // 2 ms for the answer and 10 ms for others; 50 ms for each bit that is 1.
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
fn a_bus_without_slaves() {
    assert_eq!(scan(&mut []), (Ok(Answer::Found(None)), 50));
}

#[test]
fn a_slave_that_leaves_during_the_scan() {
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
    assert_eq!(answer, Err(LssError::ScanFailed));
}

#[test]
fn several_slaves_one_after_the_other() {
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
fn nodes_of_the_same_node_id_are_told_apart() {
    let serials = [7, 6, 0x8000_0000];
    let peers = serials.map(|serial| Peer::new(1, [0xEC, 0x0A, 1, serial]));
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

#[test]
fn identification_against_real_nodes() {
    let mut bus = Bus::one(Client::new());
    let identify = |serial| Task::Identify {
        vendor: 1,
        product: 2,
        revision: [0, 3],
        serial,
    };
    let jobs = [[0, 4], [5, 9]].map(|serial| bus.client.lss(identify(serial)));
    let timing = bus.client.lss(Task::SwitchGlobal {
        configuration: true,
    });
    let refused = bus
        .client
        .lss(Task::ConfigureBitTiming { table: 0, index: 7 });
    let wanted = [
        Event::Lss(jobs[0], Ok(Answer::Exists(true))),
        Event::Lss(jobs[1], Ok(Answer::Exists(false))),
        Event::Lss(timing, Ok(Answer::Done)),
        Event::Lss(
            refused,
            Err(LssError::Refused {
                error: 1,
                specific: 0,
            }),
        ),
    ];
    assert_eq!(bus.run(), wanted);
}
