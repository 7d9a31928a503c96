//! Slaves that no standard has: what a master believes, and when it gives up.

use od_bus::fault::Fault;
use od_bus::link::{Heard, Link};
use od_bus::master::Master;
use od_bus::scan::{Options, scan};
use od_bus::watch::{By, Source, watch};
use od_model::Address;
use od_wire::{Duration, Frame, Instant};

use crate::id;

/// A slave with node ID 5 that answers each SDO request after 1 ms with what `answer` says, or not.
pub(crate) struct Slave<F> {
    now: Instant,
    waiting: Vec<Heard>,
    answer: F,
    /// Requests that it got.
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

    fn send(&mut self, frame: &Frame) -> Result<(), Fault> {
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

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Fault> {
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

/// An answer with the object of its request.
pub(crate) fn about(request: &[u8; 8], command: u8, data: [u8; 4]) -> [u8; 8] {
    let [_, low, high, sub, ..] = *request;
    let [a, b, c, d] = data;
    [command, low, high, sub, a, b, c, d]
}

/// 1000h and 1018h as any slave has them; every other object is a text without end.
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
    let scan = scan(&mut slave, Options::default(), |_| {}).expect("a link");
    assert_eq!(scan.nodes.len(), 1);
    assert_eq!(scan.nodes[0].device_type, Some(0x0403_0201));
    assert_eq!(scan.nodes[0].texts, [None, None, None]);
    let seconds = slave.now.as_micros() as f64 / 1e6;
    assert!(seconds < 5.0, "{seconds}");
    // The node hears that the transfer is over.
    assert_eq!(slave.heard.last().map(|request| request[0]), Some(0x80));
}

#[test]
fn a_watch_ends_when_it_said_it_would() {
    let mut slave = Slave::new(endless);
    let source = Source {
        address: Address::new(0x1008, 0),
        by: By::Poll,
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
fn a_read_with_a_time_limit_names_it() {
    let mut slave = Slave::new(endless);
    let mut master = Master::new(&mut slave, id(5)).within(Duration::from_secs(2));
    let Err(Fault::Node(why)) = master.upload(Address::new(0x1008, 0)) else {
        panic!("it came to an end");
    };
    assert!(why.contains("within 2 s"), "{why}");
    assert_eq!(slave.heard.last().map(|request| request[0]), Some(0x80));
}
