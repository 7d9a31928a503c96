//! A bus on which other frames of the node come between a request and its response.

use std::collections::VecDeque;

use od_model::Address;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::conform::case::{Case, built_in};
use od_tools::conform::eds::Eds;
use od_tools::conform::record::Verdict;
use od_tools::conform::rig::RealBus;
use od_tools::conform::session::{Permissions, Session};
use od_tools::link::{Heard, Link};
use od_tools::master::Master;
use od_wire::{Frame, Instant, NodeId};

use crate::simulated::bus;

/// A link that delivers the frames of the node 4 ms late; frames that the node sends in this time
/// arrive before the response.
struct Late<L> {
    link: L,
    heard: VecDeque<Heard>,
}

impl<L: Link> Link for Late<L> {
    fn now(&self) -> Instant {
        self.link.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        let arrival = self.link.now().plus_millis(4);
        while let Some(heard) = self.link.receive(arrival)? {
            self.heard.push_back(heard);
        }
        self.link.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        match self.heard.pop_front() {
            Some(heard) => Ok(Some(heard)),
            None => self.link.receive(until),
        }
    }
}

#[test]
fn heartbeats_between_request_and_response_fail_no_case() {
    for name in ["gxmm", "eam_mt", "en580c"] {
        let mut bus = bus(name);
        let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
        // Every 3 ms, also after each reset.
        for (index, sub, bytes) in [(0x1017, 0, &[3, 0][..]), (0x1010, 1, b"save")] {
            let written = master.download(Address::new(index, sub), bytes);
            assert_eq!(written, Ok(()), "{name} {index:X}");
        }
        let kind = od_devices::find(name).expect("a device");
        let eds = Eds::read(&od_devices::text::eds(kind));
        let heard = VecDeque::new();
        let link = OnBench(bus);
        let mut rig = RealBus {
            link: Box::new(Late { link, heard }),
            power: None,
            pulse: None,
        };
        let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::default());
        for case in built_in() {
            let record = session.run(case);
            if let Verdict::Fail { expected, got } = record.verdict {
                panic!("{name}, {}: expected {expected}; {got}", case.id);
            }
        }
    }
}

#[test]
fn a_case_about_heartbeats_receives_them() {
    let mut bus = bus("gxmm");
    let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
    let written = master.download(Address::new(0x1017, 0), &[3, 0]);
    assert_eq!(written, Ok(()));
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = RealBus {
        link: Box::new(OnBench(bus)),
        power: None,
        pulse: None,
    };
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::default());
    for (first, is_heard) in [("", false), ("expect 701#7F\n", true)] {
        let text = format!("# CiA 301: Own.\n# Group: NMT\n{first}expect silence 20ms\n");
        let case = Case::parse("own", &text).expect("a case");
        let heard = matches!(session.run(&case).verdict, Verdict::Fail { .. });
        assert_eq!(heard, is_heard, "{first}");
    }
}
