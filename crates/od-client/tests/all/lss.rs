//! LSS master: each service by hand, and against a node.

use crate::support::bus::Bus;
use crate::support::{at, frame};
use od_client::Error;
use od_client::lss::{Answer, Busy, Identity, Master, Options, Part, Task};
use od_client::{Client, Event, Frame, NodeId};

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

/// A service that sends these frames, and its result for this response.
#[track_caller]
fn check(task: Task, requests: &[&str], answer: &str, wanted: Result<Answer, Error>) {
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
        Task::InquireNodeId,
        &["5E"],
        "5EC8",
        Err(Error::InvalidNodeId(200)),
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
    let refused = |error, specific| Err(Error::Refused { error, specific });
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
fn some_services_have_no_response() {
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
fn identification_without_a_response_finds_no_slave() {
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
                // Three slaves respond, one after the other.
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
fn other_responses_are_ignored() {
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
        // A frame before the last request was sent is not a response.
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
            _ => Err(Error::Silent),
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
            Err(Error::Refused {
                error: 1,
                specific: 0,
            }),
        ),
    ];
    assert_eq!(bus.run(), wanted);
}
