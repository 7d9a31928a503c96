//! A node that works is never reported as lost, and a failure in one case does not affect the next.

use std::cell::Cell;
use std::collections::VecDeque;

use od_model::Address;
use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::{Record, Verdict};
use od_tools::conform::rig::Rig;
use od_tools::conform::session::{Permissions, Session};
use od_tools::link::{Heard, Link};
use od_tools::master::Master;
use od_tools::nmt;
use od_wire::nmt::Command;
use od_wire::{CanId, Duration, Frame, Instant, NodeId};

use crate::simulated::{alone, bus};

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

/// Runs all cases with resets; returns the records, and the reason of an early end.
fn run(change: impl FnMut(Frame) -> Option<Frame>) -> (Vec<Record>, Option<String>) {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = Odd {
        bus: OnBench(bus("gxmm")),
        change,
    };
    let permissions = Permissions {
        reset: true,
        store: false,
        motion: true,
    };
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, permissions);
    let records = built_in().iter().map(|case| session.run(case)).collect();
    let lost = session.lost().map(str::to_owned);
    (records, lost)
}

/// Number of cases that were skipped because of a missing response.
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
fn a_node_without_1000h_is_tested_completely() {
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
fn a_node_without_a_boot_up_message_is_tested_completely() {
    let (records, lost) = run(|frame| {
        let is_boot_up = frame.id().as_standard() == Some(0x701) && frame.data() == [0];
        (!is_boot_up).then_some(frame)
    });
    assert_eq!((lost, unheard(&records)), (None, 0));
    assert!(passed(&records) > 100, "{}", passed(&records));
}

#[test]
fn a_node_that_is_silent_for_a_while_fails_only_these_cases() {
    let mut count = 0;
    // Its frames 300 to 319 are lost.
    let (records, lost) = run(|frame| {
        count += 1;
        (!(300..320).contains(&count)).then_some(frame)
    });
    assert_eq!(lost, None);
    assert!(unheard(&records) <= 2, "{}", unheard(&records));
    assert!(passed(&records) > 100, "{}", passed(&records));
}

#[test]
fn an_error_that_is_there_before_a_case_does_not_fail_it() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    for id in [
        "emcy-reset-node",
        "emcy-register-clears",
        "heartbeat-consumer-ends",
    ] {
        // 1001h is 11h until the first boot-up message: an error that another case has left.
        let shown = Cell::new(Some(0));
        let mut rig = Odd {
            bus: OnBench(bus("gxmm")),
            change: |frame: Frame| {
                let is_boot_up = frame.id().as_standard() == Some(0x701) && frame.data() == [0];
                match (shown.get(), *frame.bytes()) {
                    (Some(1..), _) if is_boot_up => shown.set(None),
                    (Some(count), [0x4F, 1, 0x10, 0, ..]) => {
                        shown.set(Some(count + 1));
                        return Frame::new(frame.id(), &[0x4F, 1, 0x10, 0, 0x11, 0, 0, 0]);
                    }
                    _ => {}
                }
                Some(frame)
            },
        };
        let permissions = Permissions {
            reset: true,
            store: false,
            motion: false,
        };
        let mut session = Session::new(&mut rig, &eds, NodeId::ONE, permissions);
        let case = built_in().iter().find(|case| case.id == id);
        let record = session.run(case.expect("a case"));
        assert_eq!(record.verdict, Verdict::Pass, "{id}");
        assert_eq!(
            shown.get(),
            None,
            "{id}: the error was read, and a reset ended it"
        );
    }
}

#[test]
fn a_node_that_stops_ends_the_run() {
    let mut count = 0;
    let (records, lost) = run(|frame| {
        count += 1;
        (count < 300).then_some(frame)
    });
    assert_eq!(lost.as_deref(), Some("the node does not respond any more"));
    assert!(unheard(&records) > 100, "{}", unheard(&records));
}

/// A test on a busy computer: one wait in four ends late, and frames that arrived in between have the time at which they
/// were read.
struct Busy {
    bus: OnBench<Bus>,
    waiting: VecDeque<Heard>,
    random: u64,
    /// Longest delay in microseconds.
    longest: u64,
    /// Longest delay since the last look, as a thread beside the test would measure it.
    late: Cell<u64>,
    /// Frame that is received instead of one of the node; `None` if it is lost.
    spoiled: fn(Frame) -> Option<Frame>,
}

const SPOTLESS: fn(Frame) -> Option<Frame> = Some;

impl Link for Busy {
    fn now(&self) -> Instant {
        self.bus.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.bus.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        if let Some(heard) = self.waiting.pop_front() {
            return Ok(Some(heard));
        }
        if until <= self.now() {
            return self.bus.receive(until);
        }
        let mut first = self.bus.receive(until)?;
        while let Some(heard) = first {
            if let Some(frame) = (self.spoiled)(heard.frame) {
                first = Some(Heard { frame, ..heard });
                break;
            }
            first = self.bus.receive(until)?;
        }
        self.random = self
            .random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        if self.random >> 62 == 0 {
            let late = (self.random >> 33) % self.longest;
            self.late.set(self.late.get().max(late));
            let end = self.now().plus_micros(late);
            while let Some(heard) = self.bus.receive(end)? {
                let frame = (self.spoiled)(heard.frame);
                self.waiting
                    .extend(frame.map(|frame| Heard { at: end, frame }));
            }
        }
        Ok(first)
    }
}

impl Rig for Busy {
    fn slack(&self) -> u64 {
        10_000
    }

    fn host_late(&self) -> u64 {
        self.late.take()
    }
}

#[test]
fn a_busy_computer_reports_no_node_as_wrong() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    for seed in 1..40 {
        let mut rig = Busy {
            bus: OnBench(bus("gxmm")),
            waiting: VecDeque::new(),
            random: seed,
            longest: 150_000,
            late: Cell::default(),
            spoiled: SPOTLESS,
        };
        let permissions = Permissions {
            reset: true,
            store: false,
            motion: true,
        };
        let mut session = Session::new(&mut rig, &eds, NodeId::ONE, permissions);
        let records: Vec<_> = built_in().iter().map(|case| session.run(case)).collect();
        let failed = records.iter().filter(|one| one.verdict.is_fail());
        let failed: Vec<_> = failed.map(|one| (&one.id, &one.verdict)).collect();
        assert!(failed.is_empty(), "{failed:?}");
        let open = records.iter().filter(|one| match &one.verdict {
            Verdict::Skipped(why) => why.starts_with("inconclusive"),
            _ => false,
        });
        assert!(open.count() < 10);
        assert_eq!(session.lost(), None);
    }
}

/// A response does not depend on when the test read it.
#[test]
fn a_busy_computer_knows_what_a_node_accepts() {
    let kind = od_devices::find("eam_mt").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let case = built_in()
        .iter()
        .find(|case| case.id == "mapping-without-procedure");
    let case = case.expect("a case");
    for (spoiled, is_wrong) in [
        (SPOTLESS, false),
        // The abort of a mapping entry is a confirmation.
        (
            |frame: Frame| {
                let is_abort = frame.bytes()[..4] == [0x80, 0x00, 0x1A, 0x01];
                let confirmed = [0x60, 0x00, 0x1A, 0x01, 0, 0, 0, 0];
                Some(if is_abort {
                    Frame::full(frame.id(), confirmed)
                } else {
                    frame
                })
            },
            true,
        ),
    ] {
        for random in 1..20 {
            let mut rig = Busy {
                bus: OnBench(bus("eam_mt")),
                waiting: VecDeque::new(),
                random,
                longest: 15_000,
                late: Cell::default(),
                spoiled,
            };
            let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::default());
            let record = session.run(case);
            let expected = if is_wrong {
                record.verdict.is_fail()
            } else {
                record.verdict == Verdict::Pass
            };
            assert!(expected, "{random}: {:?}", record.verdict);
        }
    }
}

/// A wait of ten seconds that is some milliseconds late still counts as one of ten seconds.
#[test]
fn a_busy_computer_detects_missing_frames() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = Busy {
        bus: OnBench(bus("gxmm")),
        waiting: VecDeque::new(),
        random: 5,
        longest: 150_000,
        late: Cell::default(),
        spoiled: |frame| {
            let is_boot = frame.id().as_standard() == Some(0x701) && frame.data() == [0];
            (!is_boot).then_some(frame)
        },
    };
    let permissions = Permissions {
        reset: true,
        store: false,
        motion: true,
    };
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, permissions);
    for id in [
        "nmt-boot-up",
        "nmt-boot-up-first",
        "nmt-boot-up-communication",
    ] {
        let case = built_in().iter().find(|case| case.id == id);
        let record = session.run(case.expect("a case"));
        assert!(record.verdict.is_fail(), "{id}: {:?}", record.verdict);
    }
}

/// A node whose heartbeats are lost, by their number; the test itself is never late.
struct Starved {
    bus: OnBench<Bus>,
    beats: u32,
    is_lost: fn(u32) -> bool,
}

impl Link for Starved {
    fn now(&self) -> Instant {
        self.bus.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.bus.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        loop {
            let heard = self.bus.receive(until)?;
            let is_beat = |heard: Heard| {
                heard.frame.id().as_standard() == Some(0x701) && heard.frame.data() != [0]
            };
            self.beats += u32::from(heard.is_some_and(is_beat));
            if !heard.is_some_and(is_beat) || !(self.is_lost)(self.beats) {
                return Ok(heard);
            }
        }
    }
}

impl Rig for Starved {
    fn slack(&self) -> u64 {
        10_000
    }
}

/// A slave on the same busy computer is late when the test is not.
#[test]
fn on_a_busy_computer_too_a_node_that_never_responds_fails_its_first_case() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = Busy {
        bus: OnBench(bus("gxmm")),
        waiting: VecDeque::new(),
        random: 1,
        longest: 20_000,
        late: Cell::new(0),
        spoiled: |_| None,
    };
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::default());
    let case = built_in().iter().find(|case| case.id == "nmt-start");
    let record = session.run(case.expect("a case"));
    assert!(record.verdict.is_fail(), "{:?}", record.verdict);
    assert_eq!(record.notes, ["the node did not respond afterwards"]);
}

#[test]
fn a_failure_that_depends_on_time_must_be_seen_twice() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let case = built_in().iter().find(|case| case.id == "heartbeat-period");
    let case = case.expect("a case");
    for (is_lost, expected) in [
        ((|_| false) as fn(u32) -> bool, "pass"),
        (|beat| beat == 5, "inconclusive: it failed once"),
        (|beat| beat % 5 == 0, "fail"),
    ] {
        let mut rig = Starved {
            bus: OnBench(bus("gxmm")),
            beats: 0,
            is_lost,
        };
        let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::default());
        let verdict = session.run(case).verdict;
        let is = match &verdict {
            Verdict::Skipped(why) => why,
            other => other.word(),
        };
        assert!(is.starts_with(expected), "{expected}: {verdict:?}");
    }
}

/// A case about LSS gives the node another node ID, or none; afterwards the node has its own, also after a reset, and also if
/// it sends no boot-up message.
#[test]
fn a_node_has_its_own_node_id_after_each_case_about_lss() {
    let cases = || built_in().iter().filter(|case| case.group == "LSS");
    assert!(cases().count() > 15, "{}", cases().count());
    let own = NodeId::new(5).expect("a node ID");
    for name in ["gxmm", "eam_mt", "en580c"] {
        let kind = od_devices::find(name).expect("a device");
        let eds = Eds::read(&od_devices::text::eds(kind));
        for has_boot_up in [true, false] {
            let mut passed = 0;
            for case in cases() {
                let mut rig = Odd {
                    bus: OnBench(alone(VirtualDevice::new(kind, own))),
                    change: |frame: Frame| {
                        let is_boot_up = frame.id().raw() >> 7 == 0x700 >> 7 && frame.data() == [0];
                        (has_boot_up || !is_boot_up).then_some(frame)
                    },
                };
                let record = Session::new(&mut rig, &eds, own, Permissions::ALL).run(case);
                passed += u32::from(record.verdict.is_pass());
                let mut master = Master::new(rig.bus, own);
                for command in [Command::EnterPreOperational, Command::ResetNode] {
                    let wait = Duration::from_millis(500);
                    let told = nmt::command(master.link(), Some(own), command, wait);
                    assert!(told.is_ok(), "{told:?}");
                    let vendor = master.upload(Address::new(0x1018, 1));
                    assert!(
                        vendor.is_ok(),
                        "{name}, {}, {command:?}: {vendor:?}",
                        case.id
                    );
                }
            }
            assert!(!has_boot_up || passed > 5, "{name}: {passed}");
        }
    }
}

/// A node that takes a configured node ID at once, without a reset. Behind it, the node keeps its own.
struct Hasty {
    bus: OnBench<Bus>,
    own: u16,
    taken: u16,
}

impl Hasty {
    /// The frame with a node ID in place of another one, in its CAN-ID or in an NMT command.
    fn translated(frame: &Frame, from: u16, to: u16) -> Frame {
        let id = frame.id().as_standard().unwrap_or_default();
        match *frame.data() {
            [command, node] if id == 0 && u16::from(node) == from => {
                Frame::standard(0, &[command, to as u8])
            }
            _ if id & 0x7F == from && id < 0x780 && !frame.is_remote() => {
                let id = CanId::standard(id - from + to);
                Frame::with_dlc(id, *frame.bytes(), frame.dlc())
            }
            _ => *frame,
        }
    }
}

impl Link for Hasty {
    fn now(&self) -> Instant {
        self.bus.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        let mut frame = *frame;
        if let (Some(0x7E5), [0x11, node @ 1..=127, ..]) = (frame.id().as_standard(), frame.data())
        {
            self.taken = u16::from(*node);
            frame = Frame::standard(0x7E5, &[0x11, self.own as u8, 0, 0, 0, 0, 0, 0]);
        }
        if self.taken != self.own {
            // 7Fh is nobody's node ID here.
            frame = Self::translated(&frame, self.own, 0x7F);
            frame = Self::translated(&frame, self.taken, self.own);
        }
        self.bus.send(&frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let heard = self.bus.receive(until)?;
        Ok(heard.map(|heard| Heard {
            frame: Self::translated(&heard.frame, self.own, self.taken),
            ..heard
        }))
    }
}

impl Rig for Hasty {}

#[test]
fn a_node_that_takes_a_node_id_at_once_gets_its_own_back() {
    let own = NodeId::new(5).expect("a node ID");
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let cases = built_in().iter().filter(|case| case.group == "LSS");
    let mut failed = 0;
    for case in cases {
        let mut rig = Hasty {
            bus: OnBench(alone(VirtualDevice::new(kind, own))),
            own: 5,
            taken: 5,
        };
        let record = Session::new(&mut rig, &eds, own, Permissions::ALL).run(case);
        failed += u32::from(matches!(record.verdict, Verdict::Fail { .. }));
        assert_eq!(rig.taken, 5, "{}: {:?}", case.id, record.verdict);
    }
    assert!(failed > 1, "{failed}");
}

/// Without the permission, no frame of the test enables an axis, writes a target or sets an output.
#[test]
fn nothing_moves_without_permission() {
    let moves = |index: u16, sub: u8| match index {
        0x6040..=0x7FFF => matches!((index & 0x7FF, sub), (0x7A | 0xFF, 0) | (0xC1, 1)),
        _ => false,
    };
    for name in ["drive", "io"] {
        let kind = od_devices::find(name).expect("a device");
        let eds = Eds::read(&od_devices::text::eds(kind));
        let mut rig = OnBench(bus(name));
        let permissions = Permissions {
            motion: false,
            ..Permissions::ALL
        };
        let mut session = Session::new(&mut rig, &eds, NodeId::ONE, permissions);
        let (mut skipped, mut wrong) = (0, Vec::new());
        for case in built_in() {
            let record = session.run(case);
            let why = "the case needs --allow-motion";
            skipped += usize::from(
                matches!(&record.verdict, Verdict::Skipped(reason) if reason.starts_with(why)),
            );
            for sent in record.frames.iter().filter(|sent| sent.ours) {
                let id = sent.frame.id().as_standard().unwrap_or(0);
                let bytes = sent.frame.bytes();
                let index = u16::from_le_bytes([bytes[1], bytes[2]]);
                let is_download = id == 0x601 && bytes[0] & 0xE0 == 0x20;
                // Sub-index 0 of a list is constant; a case writes it to be refused.
                let is_output =
                    matches!(index, 0x6200..=0x6237 | 0x6411) && bytes[3] > 0 && name == "io";
                let enables = matches!(index, 0x6040 | 0x6840) && bytes[4] & 0xF == 0xF;
                let is_target = name == "drive" && moves(index, bytes[3]);
                // The RPDOs of the module map outputs only; those of the drive get other mappings.
                let is_rpdo = name == "io" && matches!(id, 0x201 | 0x301);
                if is_download && (is_output || enables || is_target) || is_rpdo {
                    wrong.push(format!("{}: {}", record.id, sent.frame));
                }
            }
        }
        assert!(wrong.is_empty(), "{name}: {wrong:#?}");
        assert!(skipped >= 6, "{name}: {skipped}");
    }
}
