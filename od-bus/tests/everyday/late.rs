//! Answers that come late: a machine that is busy, a node that is slow.

use std::collections::VecDeque;

use od_bus::bench::OnBench;
use od_bus::fault::Fault;
use od_bus::link::{Heard, Link};
use od_bus::master::Master;
use od_bus::scan::{Options, scan};
use od_model::Address;
use od_wire::{Duration, Frame, Instant, NodeId};

use crate::bus;

/// A link on which every SDO response comes later by a time.
struct Late<L> {
    link: L,
    by: Duration,
    held: VecDeque<Heard>,
}

impl<L: Link> Link for Late<L> {
    fn now(&self) -> Instant {
        self.link.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Fault> {
        self.link.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Fault> {
        loop {
            let due = self.held.front().map(|heard| heard.at);
            if due.is_some_and(|at| at <= self.now()) {
                return Ok(self.held.pop_front());
            }
            let next = due.map_or(until, |at| at.min(until));
            match self.link.receive(next)? {
                Some(Heard { at, frame }) if (0x581..0x600).contains(&frame.id().raw()) => {
                    let at = at + self.by;
                    self.held.push_back(Heard { at, frame });
                }
                Some(heard) => return Ok(Some(heard)),
                None if due.is_some_and(|at| at <= self.now()) => {}
                None if self.now() >= until => return Ok(None),
                None => {}
            }
        }
    }
}

#[test]
fn a_scan_neither_misses_a_node_nor_sees_two() {
    for node in [1, 127] {
        let mut bus = bus(&[("gxmm", node)]);
        let mut link = Late {
            link: OnBench(&mut bus),
            by: Duration::from_millis(250),
            held: VecDeque::new(),
        };
        let found = scan(&mut link, Options::default(), |_| {}).expect("a scan");
        let nodes = found.nodes.iter();
        let all: Vec<_> = nodes
            .map(|one| (one.node.raw(), one.conflict.len()))
            .collect();
        assert_eq!(all, [(node, 0)]);
        assert_eq!(found.nodes[0].identity[3], Some(1));
    }
}

#[test]
fn an_answer_to_an_earlier_request_is_not_the_answer() {
    let mut bus = bus(&[("gxmm", 1)]);
    let link = Late {
        link: OnBench(&mut bus),
        by: Duration::from_millis(600),
        held: VecDeque::new(),
    };
    let mut master = Master::patient(link, NodeId::ONE, Duration::from_millis(500));
    let late = master.upload(Address::new(0x1000, 0));
    assert!(matches!(late, Err(Fault::Node(_))), "{late:?}");
    let vendor = master.upload(Address::new(0x1018, 1));
    assert_eq!(vendor, Ok(Ok(vec![0xEC, 0, 0, 0])));
}
