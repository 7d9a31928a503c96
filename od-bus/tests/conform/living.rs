//! A node that lives is never declared dead, and the trouble of one case is not that of the next.

use od_bench::bus::Bus;
use od_bus::Error;
use od_bus::bench::OnBench;
use od_bus::conform::case::built_in;
use od_bus::conform::eds::Eds;
use od_bus::conform::record::{Record, Verdict};
use od_bus::conform::rig::Rig;
use od_bus::conform::session::{Leave, Session};
use od_bus::link::{Heard, Link};
use od_wire::{Frame, Instant, NodeId};

use crate::simulated::bus;

/// A node whose frames `change` replaces or drops.
struct Odd<F> {
    bus: OnBench<Bus>,
    change: F,
}

impl<F: FnMut(Frame) -> Option<Frame>> Link for Odd<F> {
    fn now(&self) -> Instant {
        self.bus.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.bus.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        while let Some(heard) = self.bus.receive(until)? {
            if let Some(frame) = (self.change)(heard.frame) {
                return Ok(Some(Heard { frame, ..heard }));
            }
        }
        Ok(None)
    }
}

impl<F: FnMut(Frame) -> Option<Frame>> Rig for Odd<F> {}

/// A run of all cases with resets: the records, and why it ended early.
fn run(change: impl FnMut(Frame) -> Option<Frame>) -> (Vec<Record>, Option<String>) {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = Odd {
        bus: OnBench(bus("gxmm")),
        change,
    };
    let leave = Leave {
        reset: true,
        store: false,
    };
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, leave);
    let records = built_in().iter().map(|case| session.run(case)).collect();
    let lost = session.lost().map(str::to_owned);
    (records, lost)
}

/// Number of cases that were skipped for want of a response.
fn unheard(records: &[Record]) -> usize {
    let is_one = |record: &&Record| match &record.verdict {
        Verdict::Skipped(why) => why.contains("respond"),
        _ => false,
    };
    records.iter().filter(is_one).count()
}

fn passed(records: &[Record]) -> usize {
    let passed = records.iter().filter(|one| one.verdict == Verdict::Pass);
    passed.count()
}

#[test]
fn a_node_without_1000h_is_tested_in_whole() {
    let (records, lost) = run(|frame| match *frame.bytes() {
        [_, 0, 0x10, 0, ..] if frame.id().as_standard() == Some(0x581) => {
            Some(Frame::standard(0x581, &[0x80, 0, 0x10, 0, 0, 0, 2, 6]))
        }
        _ => Some(frame),
    });
    assert_eq!((lost, unheard(&records)), (None, 0));
    assert!(passed(&records) > 100, "{}", passed(&records));
}

#[test]
fn a_node_without_a_boot_up_message_is_tested_in_whole() {
    let (records, lost) = run(|frame| {
        let is_boot_up = frame.id().as_standard() == Some(0x701) && frame.data() == [0];
        (!is_boot_up).then_some(frame)
    });
    assert_eq!((lost, unheard(&records)), (None, 0));
    assert!(passed(&records) > 100, "{}", passed(&records));
}

#[test]
fn a_node_that_is_silent_for_a_while_loses_these_cases_only() {
    let mut count = 0;
    // Its frames 300 to 330 are lost.
    let (records, lost) = run(|frame| {
        count += 1;
        (!(300..330).contains(&count)).then_some(frame)
    });
    assert_eq!(lost, None);
    assert!(unheard(&records) <= 2, "{}", unheard(&records));
    assert!(passed(&records) > 100, "{}", passed(&records));
}

#[test]
fn a_dead_node_ends_the_run() {
    let mut count = 0;
    let (records, lost) = run(|frame| {
        count += 1;
        (count < 300).then_some(frame)
    });
    assert_eq!(lost.as_deref(), Some("the node does not respond any more"));
    assert!(unheard(&records) > 100, "{}", unheard(&records));
}
