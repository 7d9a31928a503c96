//! Scans, bit-rate detection and NMT commands.

use od_model::Address;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::link::{Heard, Link};
use od_tools::master::Master;
use od_tools::nmt;
use od_tools::scan::{RATES, Scan, ScanTimes, detect, scan};
use od_wire::nmt::{Command, State};
use od_wire::{Duration, Frame, Instant};

use crate::{bus, id};

fn look(link: &mut impl Link) -> Scan {
    scan(link, ScanTimes::default(), |_| {}).expect("a link")
}

#[test]
fn all_devices_are_found_with_their_identities() {
    let names: Vec<(&str, u8)> = od_devices::DEVICES
        .iter()
        .map(|kind| kind.name)
        .zip(3..)
        .collect();
    let mut bus = bus(&names);
    let found = look(&mut OnBench(&mut bus));
    assert!(!found.has_unconfigured);
    assert_eq!(found.nodes.len(), od_devices::DEVICES.len());
    for (kind, one) in od_devices::DEVICES.iter().zip(&found.nodes) {
        let value = |index, sub| {
            let entry = kind.dictionary.entry(index, sub).expect("a value");
            entry.default.integer(one.node.raw())
        };
        assert_eq!(
            one.device_type.map(i128::from),
            value(0x1000, 0),
            "{}",
            kind.name
        );
        for (part, sub) in one.identity.iter().zip(1..=3) {
            assert_eq!(part.map(i128::from), value(0x1018, sub), "{}", kind.name);
        }
        assert!(one.answers && one.conflict.is_empty() && one.identity[3].is_some());
        assert!(one.texts[0].as_ref().is_some_and(|name| !name.is_empty()));
    }
}

#[test]
fn two_nodes_with_one_node_id_are_a_conflict() {
    let mut bus = bus(&[("gxmm", 5), ("gdam", 5), ("gcmm", 6)]);
    let found = look(&mut OnBench(&mut bus));
    let conflicts: Vec<(u8, usize)> = found
        .nodes
        .iter()
        .map(|one| (one.node.raw(), one.conflict.len()))
        .collect();
    assert_eq!(conflicts, [(5, 2), (6, 0)]);
}

#[test]
fn a_stopped_node_is_found_by_its_heartbeat_and_a_scan_changes_nothing() {
    let mut bus = bus(&[("gxmm", 5), ("gcmm", 6)]);
    let mut link = OnBench(&mut bus);
    let heartbeat = Address::new(0x1017, 0);
    for node in [5, 6] {
        let mut master = Master::new(&mut link, id(node));
        assert_eq!(master.download(heartbeat, &[200, 0]), Ok(()));
    }
    let wait = Duration::from_millis(500);
    let states = nmt::command(&mut link, Some(id(5)), Command::Stop, wait).expect("a link");
    assert_eq!(states.get(&id(5)), Some(&State::Stopped));
    nmt::command(&mut link, Some(id(6)), Command::Start, wait).expect("a link");
    for _ in 0..2 {
        let found = look(&mut link);
        let states: Vec<_> = found
            .nodes
            .iter()
            .map(|one| (one.state, one.answers))
            .collect();
        let operational = Some(State::Operational);
        assert_eq!(states, [(Some(State::Stopped), false), (operational, true)]);
    }
}

#[test]
fn a_reset_of_all_nodes_is_reported_by_boot_up_messages() {
    let mut bus = bus(&[("gxmm", 5), ("eam_mt", 9)]);
    let mut link = OnBench(&mut bus);
    let wait = Duration::from_secs(2);
    let states = nmt::command(&mut link, None, Command::ResetNode, wait).expect("a link");
    let all = [(id(5), State::Initialising), (id(9), State::Initialising)];
    assert_eq!(states.into_iter().collect::<Vec<_>>(), all);
}

/// A bus with a heartbeat each second, at one bit rate.
struct At {
    rate: Option<u16>,
    own: u16,
    now: Instant,
}

impl Link for At {
    fn now(&self) -> Instant {
        self.now
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        panic!("{frame} is sent while it only listens");
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        let next = self.now.plus_millis(1000);
        if self.rate != Some(self.own) || next > until {
            self.now = until;
            return Ok(None);
        }
        self.now = next;
        let frame = Frame::standard(0x705, &[5]);
        Ok(Some(Heard { at: next, frame }))
    }

    fn listen_at(&mut self, kbit: u16) -> Result<(), Error> {
        self.rate = Some(kbit);
        Ok(())
    }
}

#[test]
fn a_bit_rate_is_found_by_listening() {
    let wait = Duration::from_millis(1500);
    for own in RATES {
        let mut link = At {
            rate: None,
            own,
            now: Instant::ZERO,
        };
        assert_eq!(detect(&mut link, wait, |_| {}), Ok(Some(own)));
    }
    let mut silent = At {
        rate: None,
        own: 33,
        now: Instant::ZERO,
    };
    assert_eq!(detect(&mut silent, wait, |_| {}), Ok(None));
    let mut bench = bus(&[]);
    let cannot = detect(&mut OnBench(&mut bench), wait, |_| {});
    assert!(matches!(cannot, Err(Error::Usage(_))), "{cannot:?}");
}
