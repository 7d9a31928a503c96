//! A run that is stopped in the middle, by Ctrl-C or by the loss of the link.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use od_model::{Access, Address};
use od_sim::bus::Bus;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::{Record, Verdict};
use od_tools::conform::report::{About, Format, Report};
use od_tools::conform::rig::{RealBus, Rig};
use od_tools::conform::session::{Permissions, Session};
use od_tools::interrupt::Interruptible;
use od_tools::learn::{Options, learn};
use od_tools::link::{Heard, Link};
use od_tools::master::Master;
use od_wire::{Frame, Instant, NodeId};

use crate::simulated::bus;

/// A link that calls a function when a frame is sent.
struct Trip<L, F> {
    link: L,
    act: F,
}

impl<L: Link, F: FnMut(&str) -> Result<(), Error>> Link for Trip<L, F> {
    fn now(&self) -> Instant {
        self.link.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        (self.act)(&frame.to_string())?;
        self.link.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        self.link.receive(until)
    }
}

/// All values that a master can write.
fn values(bus: &mut Bus, eds: &Eds) -> Vec<(Address, Option<Vec<u8>>)> {
    let mut master = Master::new(OnBench(bus), NodeId::ONE);
    let entries = eds
        .dictionary()
        .entries()
        .filter(|one| one.access == Access::Rw);
    entries
        .map(|one| (one.address, master.upload(one.address).ok()))
        .collect()
}

/// Runs all cases; returns the report.
fn run(rig: &mut dyn Rig, eds: &Eds) -> Report {
    let mut session = Session::new(rig, eds, NodeId::ONE, Permissions::default());
    let records: Vec<Record> = built_in().iter().map(|case| session.run(case)).collect();
    Report {
        about: About::default(),
        device: eds.title(),
        eds: "the built-in EDS".into(),
        link: "bench".into(),
        node: 1,
        records,
        times: session.times().clone(),
        lost: session.lost().map(str::to_owned),
    }
}

#[test]
fn ctrl_c_in_a_case_restores_its_changes() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut bus = bus("gxmm");
    let before = values(&mut bus, &eds);
    let stop = Arc::new(AtomicBool::new(false));
    // `heartbeat-states` and other cases write 1017h = 50.
    let trip = Trip {
        link: OnBench(&mut bus),
        act: |frame: &str| {
            if frame.starts_with("601#2B17100032") {
                stop.store(true, Ordering::Relaxed);
            }
            Ok(())
        },
    };
    let mut link = Interruptible::new(trip, Arc::clone(&stop));
    let report = run(&mut OnLink(&mut link), &eds);
    assert_eq!(report.lost.as_deref(), Some("stopped by Ctrl-C"));
    let notes: Vec<_> = report.records.iter().flat_map(|one| &one.notes).collect();
    assert!(
        notes.iter().any(|note| note.starts_with("put back 1017h")),
        "{notes:?}"
    );
    let text = report.render(Format::Text);
    assert!(text.contains("changed and put back: "), "{text}");
    assert!(
        text.contains("the run ended early: stopped by Ctrl-C"),
        "{text}"
    );
    assert_eq!(values(&mut bus, &eds), before);
}

/// A link whose power cannot be switched.
struct OnLink<'l>(&'l mut dyn Link);

impl Link for OnLink<'_> {
    fn now(&self) -> Instant {
        self.0.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.0.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        self.0.receive(until)
    }

    fn resume(&mut self) {
        self.0.resume();
    }
}

impl Rig for OnLink<'_> {}

#[test]
fn a_lost_link_ends_in_a_report_about_unrestored_values() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let (mut is_changed, mut is_cut) = (false, false);
    let mut link = Trip {
        link: OnBench(bus("gxmm")),
        act: |frame: &str| {
            // The link is lost after the first frame that follows the change of 1017h.
            is_cut |= is_changed;
            is_changed |= frame.starts_with("601#2B17100032");
            if is_cut {
                Err(Error::Link("the other end has gone".into()))
            } else {
                Ok(())
            }
        },
    };
    let report = run(&mut OnLink(&mut link), &eds);
    let why = "the link is lost: the other end has gone";
    assert_eq!(report.lost.as_deref(), Some(why));
    assert!(!report.is_pass());
    let last = &report.records.last().expect("a record").verdict;
    assert_eq!(*last, Verdict::Skipped(why.into()));
    for (_, format) in Format::ALL {
        assert!(report.render(format).contains("the other end has gone"));
    }
    let notes: Vec<_> = report.records.iter().flat_map(|one| &one.notes).collect();
    let left = notes
        .iter()
        .filter(|note| note.starts_with("could not put back"));
    assert!(left.count() > 0, "{notes:?}");
    let text = report.render(Format::Text);
    assert!(text.contains("could not put back 1017h"), "{text}");
}

#[test]
fn ctrl_c_in_learn_restores_the_probed_value() {
    let kind = od_devices::find("en580c").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut bus = bus("en580c");
    let before = values(&mut bus, &eds);
    let stop = Arc::new(AtomicBool::new(false));
    let trip = Trip {
        link: OnBench(&mut bus),
        // The highest number of 1017h.
        act: |frame: &str| {
            if frame.starts_with("601#2B171000FFFF") {
                stop.store(true, Ordering::Relaxed);
            }
            Ok(())
        },
    };
    let link = Interruptible::new(trip, Arc::clone(&stop));
    let options = Options {
        writes: true,
        ..Options::default()
    };
    let made = learn(link, NodeId::ONE, options, |_| {}).expect("all objects");
    assert_eq!(made.left, Some(Error::Interrupted));
    assert!(
        made.description.objects.len() > 50,
        "what was learned stays"
    );
    assert_eq!(values(&mut bus, &eds), before);
}

#[cfg(unix)]
#[test]
fn a_power_command_that_fails_is_named() {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = RealBus {
        link: Box::new(OnBench(bus("gxmm"))),
        power: Some("exit 3; echo".into()),
        pulse: None,
    };
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::ALL);
    let case = built_in().iter().find(|case| case.id == "nmt-power-on");
    let record = session.run(case.expect("a case"));
    let Verdict::Skipped(why) = &record.verdict else {
        panic!("{:?}", record.verdict);
    };
    assert!(why.contains("`exit 3; echo off`: exit status: 3"), "{why}");
}
