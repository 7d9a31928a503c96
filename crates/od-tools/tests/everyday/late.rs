//! Late responses: a busy computer, a slow node.

use std::collections::VecDeque;

use od_model::Address;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::link::{Heard, Link};
use od_tools::master::Master;
use od_tools::scan::{ScanTimes, scan};
use od_wire::{Duration, Frame, Instant, NodeId};

use crate::bus;

/// A link with delayed frames.
pub(crate) struct Late<'f, L> {
    link: L,
    /// Delay of a frame in ms.
    by: Box<dyn FnMut(&Frame) -> u64 + 'f>,
    held: VecDeque<Heard>,
}

impl<'f, L: Link> Late<'f, L> {
    pub(crate) fn new(link: L, by: impl FnMut(&Frame) -> u64 + 'f) -> Self {
        Self {
            link,
            by: Box::new(by),
            held: VecDeque::new(),
        }
    }

    /// Delays every SDO response by `millis` ms.
    fn responses(link: L, millis: u64) -> Self {
        let is_response = |frame: &Frame| (0x581..0x600).contains(&frame.id().raw());
        Self::new(
            link,
            move |frame| if is_response(frame) { millis } else { 0 },
        )
    }
}

impl<L: Link> Link for Late<'_, L> {
    fn now(&self) -> Instant {
        self.link.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.link.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        loop {
            let due = self.held.front().map(|heard| heard.at);
            if due.is_some_and(|at| at <= self.now()) {
                return Ok(self.held.pop_front());
            }
            let next = due.map_or(until, |at| at.min(until));
            match self.link.receive(next)? {
                Some(heard) => match (self.by)(&heard.frame) {
                    0 => return Ok(Some(heard)),
                    millis => {
                        let at = heard.at.plus_millis(millis);
                        self.held.push_back(Heard { at, ..heard });
                    }
                },
                None if due.is_some_and(|at| at <= self.now()) => {}
                None if self.now() >= until => return Ok(None),
                None => {}
            }
        }
    }
}

#[test]
fn a_scan_of_slow_nodes_neither_misses_a_node_nor_sees_two() {
    for node in [1, 127] {
        let mut bus = bus(&[("gxmm", node)]);
        let mut link = Late::responses(OnBench(&mut bus), 250);
        let found = scan(&mut link, ScanTimes::default(), |_| {}).expect("a scan");
        let nodes = found.nodes.iter();
        let all: Vec<_> = nodes
            .map(|one| (one.node.raw(), one.conflict.len()))
            .collect();
        assert_eq!(all, [(node, 0)]);
        assert_eq!(found.nodes[0].identity[3], Some(1));
    }
}

/// A link on which each SDO response is another frame.
struct Instead<L>(L, fn(Frame) -> Frame);

impl<L: Link> Link for Instead<L> {
    fn now(&self) -> Instant {
        self.0.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.0.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let mut heard = self.0.receive(until)?;
        if let Some(heard) = &mut heard
            && heard.frame.id().raw() == 0x581
        {
            heard.frame = (self.1)(heard.frame);
        }
        Ok(heard)
    }
}

#[test]
fn a_response_that_is_too_short_for_its_value_is_named() {
    let read = |instead| {
        let mut bus = bus(&[("gxmm", 1)]);
        let mut master = Master::new(Instead(OnBench(&mut bus), instead), NodeId::ONE);
        let fault = master
            .upload(Address::new(0x1000, 0))
            .expect_err("no value");
        fault.to_string()
    };
    let short = read(|frame| Frame::new(frame.id(), &frame.data()[..5]).expect("5 bytes"));
    assert!(
        short.contains("the length of a response is 5, and its content needs 8"),
        "{short}"
    );
}

#[test]
fn a_response_to_an_earlier_request_does_not_count() {
    let mut bus = bus(&[("gxmm", 1)]);
    let link = Late::responses(OnBench(&mut bus), 600);
    let mut master = Master::patient(link, NodeId::ONE, Duration::from_millis(500));
    let late = master.upload(Address::new(0x1000, 0));
    assert!(matches!(late, Err(Error::Node(_))), "{late:?}");
    let vendor = master.upload(Address::new(0x1018, 1));
    assert_eq!(vendor, Ok(vec![0xEC, 0, 0, 0]));
}
