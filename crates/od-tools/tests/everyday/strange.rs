//! Slaves that violate the standards: what a master accepts, and when it gives up.

use od_eds::diff::Field;
use od_model::Address;
use od_tools::Error;
use od_tools::compare::compare;
use od_tools::configure::{Setting, apply};
use od_tools::learn::{Options, learn};
use od_tools::link::{Heard, Link};
use od_tools::master::Master;
use od_tools::scan::{ScanTimes, SdoFault, scan};
use od_tools::watch::{By, Source, sources, watch};
use od_wire::{Duration, Frame, Instant};

use crate::id;

/// A slave with node ID 5 that responds to each SDO request after 1 ms with the result of `answer`,
/// or not at all.
pub(crate) struct Slave<F> {
    now: Instant,
    waiting: Vec<Heard>,
    answer: F,
    /// Received requests.
    pub(crate) heard: Vec<[u8; 8]>,
}

impl<F: FnMut(&[u8; 8]) -> Option<[u8; 8]>> Slave<F> {
    pub(crate) fn new(answer: F) -> Self {
        Self {
            now: Instant::ZERO,
            waiting: Vec::new(),
            answer,
            heard: Vec::new(),
        }
    }
}

impl<F: FnMut(&[u8; 8]) -> Option<[u8; 8]>> Link for Slave<F> {
    fn now(&self) -> Instant {
        self.now
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        if frame.id().as_standard() == Some(0x605) {
            self.heard.push(*frame.bytes());
            if let Some(bytes) = (self.answer)(frame.bytes()) {
                self.waiting.push(Heard {
                    at: self.now.plus_millis(1),
                    frame: Frame::standard(0x585, &bytes),
                });
            }
        }
        Ok(())
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let due = self.waiting.first().map(|heard| heard.at);
        if due.is_some_and(|due| due <= until.max(self.now)) {
            let heard = self.waiting.remove(0);
            self.now = self.now.max(heard.at);
            return Ok(Some(heard));
        }
        self.now = self.now.max(until);
        Ok(None)
    }
}

/// A response with the object of its request.
pub(crate) fn about(request: &[u8; 8], command: u8, data: [u8; 4]) -> [u8; 8] {
    let [_, low, high, sub, ..] = *request;
    let [a, b, c, d] = data;
    [command, low, high, sub, a, b, c, d]
}

/// The usual 1000h and 1018h; every other object is a text without end.
fn endless(request: &[u8; 8]) -> Option<[u8; 8]> {
    let index = u16::from_le_bytes([request[1], request[2]]);
    Some(match (request[0] >> 5, index) {
        (2, 0x1000 | 0x1018) => about(request, 0x43, [1, 2, 3, 4]),
        (2, _) => about(request, 0x40, [0; 4]),
        (3, _) => [request[0] & 0x10, b'a', b'b', b'c', b'd', b'e', b'f', b'g'],
        _ => return None,
    })
}

#[test]
fn a_scan_ends_whatever_a_node_sends() {
    let mut slave = Slave::new(endless);
    let scan = scan(&mut slave, ScanTimes::default(), |_| {}).expect("a link");
    assert_eq!(scan.nodes.len(), 1);
    assert_eq!(scan.nodes[0].device_type, Some(0x0403_0201));
    assert_eq!(scan.nodes[0].texts, [None, None, None]);
    let seconds = slave.now.as_micros() as f64 / 1e6;
    assert!(seconds < 5.0, "{seconds}");
    // The node is told that the transfer has ended.
    assert_eq!(slave.heard.last().map(|request| request[0]), Some(0x80));
}

#[test]
fn a_watch_ends_at_its_time() {
    let mut slave = Slave::new(endless);
    let source = Source {
        address: Address::new(0x1008, 0),
        by: By::Poll,
        data_type: None,
    };
    let until = Instant::ZERO.plus_millis(2000);
    let every = Duration::from_millis(200);
    let mut samples = 0;
    let done = watch(&mut slave, id(5), &[source], every, until, |_| {
        samples += 1;
        true
    });
    assert_eq!((done, samples), (Ok(()), 0));
    assert!(slave.now <= until.plus_millis(5), "{:?}", slave.now);
    assert_eq!(slave.heard.last().map(|request| request[0]), Some(0x80));
}

#[test]
fn a_value_is_polled_if_the_parameters_of_tpdos_cannot_be_read() {
    let mut slave = Slave::new(endless);
    let mut master = Master::new(&mut slave, id(5));
    let address = Address::new(0x1000, 0);
    let found = sources(&mut master, &[address]).expect("a node that responds");
    assert!(
        matches!(found[..], [Source { by: By::Poll, .. }]),
        "{found:?}"
    );
}

#[test]
fn a_read_with_a_time_limit_names_it() {
    let mut slave = Slave::new(endless);
    let mut master = Master::new(&mut slave, id(5)).within(Duration::from_secs(2));
    let Err(Error::Protocol(why)) = master.upload(Address::new(0x1008, 0)) else {
        panic!("it came to an end");
    };
    assert!(why.contains("within 2 s"), "{why}");
    assert_eq!(slave.heard.last().map(|request| request[0]), Some(0x80));
}

#[test]
fn a_value_without_end_is_given_up_after_a_minute() {
    // A text of the standard, and an object without a known type.
    for index in [0x1008, 0x2000] {
        let mut slave = Slave::new(endless);
        let mut master = Master::new(&mut slave, id(5));
        let Err(Error::Protocol(why)) = master.upload(Address::new(index, 0)) else {
            panic!("it came to an end");
        };
        let place = format!("{index:04X}h");
        assert!(why.contains(&place) && why.contains("within 60 s"), "{why}");
        let seconds = slave.now.as_micros() / 1_000_000;
        assert!((60..62).contains(&seconds), "{seconds}");
        assert_eq!(slave.heard.last().map(|request| request[0]), Some(0x80));
    }
}

#[test]
fn a_number_without_end_is_read_to_a_little_more_than_its_type() {
    let mut slave = Slave::new(endless);
    let mut master = Master::new(&mut slave, id(5));
    // 1006h is an UNSIGNED32 of the standard.
    let Err(Error::Protocol(why)) = master.upload(Address::new(0x1006, 0)) else {
        panic!("it came to an end");
    };
    assert!(why.contains("1006h") && why.contains("UNSIGNED32"), "{why}");
    assert!(slave.heard.len() < 15, "{} requests", slave.heard.len());
    assert_eq!(slave.heard.last().map(|request| request[0]), Some(0x80));
}

/// A server with 1000h, 1018h:00 to 03 and 2001h, whose 2000h is a text with the wrong toggle bit. It does not respond to
/// requests for 2002h.
fn faulty(request: &[u8; 8]) -> Option<[u8; 8]> {
    let index = u16::from_le_bytes([request[1], request[2]]);
    Some(match (request[0] >> 5, index, request[3]) {
        (_, 0x2002, _) => return None,
        (2, 0x1000 | 0x2001, 0) => about(request, 0x43, [1, 2, 3, 4]),
        (2, 0x1018, 0) => about(request, 0x4F, [3, 0, 0, 0]),
        (2, 0x1018, 1..=3) => about(request, 0x43, [1, 2, 3, 4]),
        (2, 0x2000, 0) => about(request, 0x41, [16, 0, 0, 0]),
        (2, 0x1000 | 0x1018 | 0x2000 | 0x2001, _) => about(request, 0x80, [0x11, 0, 9, 6]),
        (2 | 5, ..) => about(request, 0x80, [0, 0, 2, 6]),
        (3, ..) => [!request[0] & 0x10, b'a', b'b', b'c', b'd', b'e', b'f', b'g'],
        (1, ..) => about(request, 0x80, [2, 0, 1, 6]),
        _ => return None,
    })
}

#[test]
fn a_fault_of_one_object_does_not_end_learning() {
    let mut slave = Slave::new(faulty);
    let made = learn(&mut slave, id(5), Options::default(), |_| {}).expect("a node");
    let objects: Vec<u16> = made.description.objects.keys().copied().collect();
    assert_eq!(objects, [0x1000, 0x1018, 0x2000, 0x2001]);
    let [toggle, silent] = made.faults.as_slice() else {
        panic!("{:?}", made.faults);
    };
    assert!(
        toggle.contains("2000h") && toggle.contains("toggle"),
        "{toggle}"
    );
    assert!(
        silent.contains("2002h") && silent.contains("does not respond"),
        "{silent}"
    );
    // A node that has become silent is not asked for 36,864 objects.
    let mut requests = 0;
    let mut slave = Slave::new(|request: &[u8; 8]| {
        requests += 1;
        faulty(request).filter(|_| requests < 100)
    });
    let made = learn(&mut slave, id(5), Options::default(), |_| {});
    assert!(matches!(made, Err(Error::Node(_))), "{made:?}");
    let seconds = slave.now.as_micros() / 1_000_000;
    assert!(seconds < 10, "{seconds}");
}

#[test]
fn a_fault_of_one_object_does_not_end_a_comparison() {
    let mut text = String::from("[MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n");
    text += "[ManufacturerObjects]\nSupportedObjects=4\n1=0x2000\n2=0x2001\n3=0x2002\n4=0x2003\n";
    for (index, data_type) in [
        (0x1000, 7),
        (0x2000, 9),
        (0x2001, 7),
        (0x2002, 7),
        (0x2003, 7),
    ] {
        text += &format!("[{index:X}]\nParameterName=Value\nDataType={data_type}\nAccessType=ro\n");
    }
    let tables = od_eds::Tables::new(&od_eds::parse(&text).description);
    let mut slave = Slave::new(faulty);
    let found = compare(
        tables.dictionary(),
        &mut Master::new(&mut slave, id(5)),
        false,
    );
    let found: Vec<(u16, Field)> = found
        .expect("a node")
        .iter()
        .map(|one| (one.index, one.field))
        .collect();
    let wanted = [
        (0x2000, Field::Transfer),
        (0x2002, Field::Transfer),
        (0x2003, Field::ObjectRemoved),
    ];
    assert_eq!(found, wanted);
}

#[test]
fn a_node_whose_responses_name_another_object_is_found() {
    let mut slave = Slave::new(|request: &[u8; 8]| {
        let mut answer = about(request, 0x43, [1, 2, 3, 4]);
        answer[1] ^= 1;
        Some(answer)
    });
    let scan = scan(&mut slave, ScanTimes::default(), |_| {}).expect("a link");
    let found: Vec<_> = scan
        .nodes
        .iter()
        .map(|one| (one.node.raw(), one.answers, one.fault))
        .collect();
    assert_eq!(found, [(5, false, Some(SdoFault::OtherObject))]);
}

/// A server that never indicates the size of an expedited value: 2001h is 1000, an UNSIGNED16.
fn without_size(request: &[u8; 8]) -> Option<[u8; 8]> {
    let command = if request[0] >> 5 == 2 { 0x42 } else { 0x60 };
    Some(about(request, command, [0xE8, 3, 0, 0]))
}

#[test]
fn a_value_without_a_size_is_read_by_its_type() {
    const EDS: &str = "[MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n[1000]\nParameterName=Type\n\
        DataType=7\nAccessType=ro\n[ManufacturerObjects]\nSupportedObjects=1\n1=0x2001\n[2001]\n\
        ParameterName=Gain\nDataType=6\nAccessType=rw\n";
    let tables = od_eds::Tables::new(&od_eds::parse(EDS).description);
    let gain = Address::new(0x2001, 0);
    let mut slave = Slave::new(without_size);
    let mut master = Master::new(&mut slave, id(5));
    assert_eq!(master.upload(gain), Ok(vec![0xE8, 3, 0, 0]));
    // The standard gives the type of 1017h.
    assert_eq!(master.upload(Address::new(0x1017, 0)), Ok(vec![0xE8, 3]));
    master.know(tables.dictionary());
    assert_eq!(master.upload(gain), Ok(vec![0xE8, 3]));
    let found = compare(tables.dictionary(), &mut master, false);
    assert_eq!(found, Ok(Vec::new()));
    let setting = Setting {
        address: gain,
        bytes: vec![0xE8, 3],
    };
    let applied = apply(&mut master, &[setting], |_| {}).expect("a node");
    assert_eq!(
        (applied.equal, applied.written, applied.wrong.len()),
        (1, 0, 0)
    );
    drop(master);
    let source = Source {
        address: gain,
        by: By::Poll,
        data_type: Some(od_model::DataType::Unsigned16),
    };
    let mut value = None;
    let until = slave.now.plus_millis(50);
    let every = Duration::from_millis(200);
    watch(&mut slave, id(5), &[source], every, until, |sample| {
        value = sample.value.ok();
        false
    })
    .expect("a link");
    assert_eq!(value, Some(vec![0xE8, 3]));
}

#[test]
fn a_long_value_is_one_transfer() {
    let text = b"a text that is so long that a client could think of a block transfer for it, though it asked";
    let mut left: Vec<u8> = Vec::new();
    let mut slave = Slave::new(move |request| match request[0] >> 5 {
        2 => {
            left = text.to_vec();
            Some(about(request, 0x41, (text.len() as u32).to_le_bytes()))
        }
        3 => {
            let rest = left.split_off(left.len().min(7));
            let last = u8::from(rest.is_empty());
            let mut answer = [0; 8];
            answer[0] = request[0] & 0x10 | ((7 - left.len() as u8) << 1) | last;
            answer[1..=left.len()].copy_from_slice(&left);
            left = rest;
            Some(answer)
        }
        _ => None,
    });
    let mut master = Master::new(&mut slave, id(5));
    assert_eq!(master.upload(Address::new(0x1008, 0)), Ok(text.to_vec()));
    drop(master);
    let begins: Vec<u8> = slave.heard.iter().map(|request| request[0] >> 5).collect();
    assert_eq!(
        begins.iter().filter(|command| **command != 3).count(),
        1,
        "{begins:?}"
    );
}

#[test]
fn a_node_that_responds_once_is_told_from_one_that_lacks_its_identity() {
    let mut requests = 0;
    let mut once = Slave::new(|request: &[u8; 8]| {
        requests += 1;
        (requests <= 2).then(|| about(request, 0x43, [1, 0, 0, 0]))
    });
    let found = scan(&mut once, ScanTimes::default(), |_| {}).expect("a link");
    assert_eq!(found.nodes[0].fault, Some(SdoFault::Once));
    let mut without = Slave::new(|request: &[u8; 8]| {
        let index = u16::from_le_bytes([request[1], request[2]]);
        (index == 0x1000).then(|| about(request, 0x43, [1, 0, 0, 0]))
    });
    let found = scan(&mut without, ScanTimes::default(), |_| {}).expect("a link");
    assert_eq!((found.nodes[0].answers, found.nodes[0].fault), (true, None));
}

/// To each request a value with the wrong toggle bit: the node would seem to have 36,864 objects.
#[test]
fn a_node_that_violates_the_protocol_in_each_transfer_is_not_asked_for_every_object() {
    let mut slave = Slave::new(|request: &[u8; 8]| match request[0] >> 5 {
        2 => Some(about(request, 0x41, [20, 0, 0, 0])),
        3 => Some([0x10, 1, 2, 3, 4, 5, 6, 7]),
        _ => None,
    });
    let made = learn(&mut slave, id(5), Options::default(), |_| {});
    assert!(matches!(made, Err(Error::Protocol(_))), "{made:?}");
    assert!(slave.heard.len() < 1000, "{}", slave.heard.len());
}

/// A node with 2000h to 2002h, which are 1, whose response to a download of 2001h is `to_second`.
fn kept(
    values: &mut [u8; 3],
    request: &[u8; 8],
    to_second: impl FnOnce(&[u8; 8]) -> Option<[u8; 8]>,
) -> Option<[u8; 8]> {
    let at = usize::from(request[1]);
    match request[0] >> 5 {
        2 => Some(about(request, 0x4F, [values[at], 0, 0, 0])),
        1 if at == 1 && request[4] != 1 => to_second(request),
        1 => {
            values[at] = request[4];
            Some(about(request, 0x60, [0; 4]))
        }
        _ => None,
    }
}

/// The settings 2000h to 2002h = 9.
fn nines() -> Vec<Setting> {
    let setting = |at: u16| Setting {
        address: Address::new(0x2000 + at, 0),
        bytes: vec![9],
    };
    (0..3).map(setting).collect()
}

#[test]
fn a_transfer_that_fails_while_a_configuration_is_written_restores_the_earlier_values() {
    let mut values = [1; 3];
    let mut slave = Slave::new(|request: &[u8; 8]| {
        kept(&mut values, request, |request| {
            let mut other = about(request, 0x60, [0; 4]);
            other[1] = 0x99;
            Some(other)
        })
    });
    let applied = apply(&mut Master::new(&mut slave, id(5)), &nines(), |_| {}).expect("a node");
    assert!(applied.is_put_back && applied.left.is_empty() && applied.ended.is_none());
    let wrong: Vec<_> = applied
        .wrong
        .iter()
        .map(|one| one.setting.address)
        .collect();
    assert_eq!(wrong, [Address::new(0x2001, 0)]);
    assert!(matches!(applied.wrong[0].found, Err(Error::Protocol(_))));
    drop(slave);
    assert_eq!(values, [1; 3]);
}

#[test]
fn a_node_that_dies_while_a_configuration_is_written_leaves_its_values_unknown() {
    let (mut values, mut is_dead) = ([1; 3], false);
    let mut slave = Slave::new(|request: &[u8; 8]| {
        let answer = kept(&mut values, request, |_| {
            is_dead = true;
            None
        });
        answer.filter(|_| !is_dead)
    });
    let applied = apply(&mut Master::new(&mut slave, id(5)), &nines(), |_| {}).expect("a node");
    assert!(matches!(applied.ended, Some(Error::Node(_))), "{applied:?}");
    assert!(!applied.is_put_back);
    assert_eq!(applied.left.len(), 3);
}

#[test]
fn a_watch_reads_again_after_a_response_to_another_request() {
    let mut requests = 0;
    let mut slave = Slave::new(|request: &[u8; 8]| {
        requests += 1;
        let mut answer = about(request, 0x4F, [requests, 0, 0, 0]);
        if requests == 1 {
            answer[1] ^= 1;
        }
        Some(answer)
    });
    let source = Source {
        address: Address::new(0x2000, 0),
        by: By::Poll,
        data_type: None,
    };
    let until = Instant::ZERO.plus_millis(100);
    let every = Duration::from_millis(200);
    let mut samples = Vec::new();
    let done = watch(&mut slave, id(5), &[source], every, until, |sample| {
        samples.push(sample.value);
        true
    });
    assert_eq!((done, samples), (Ok(()), vec![Ok(vec![2])]));
}
