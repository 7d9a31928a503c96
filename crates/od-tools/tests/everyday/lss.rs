//! LSS: slaves without a node ID are found, get a node ID, and are left in waiting state.

use od_client::lss::Identity;
use od_model::Address;
use od_sim::bus::Bus;
use od_sim::{EdsOptions, VirtualDevice};
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::link::{Heard, Link};
use od_tools::lss::{Lss, Slaves};
use od_tools::master::Master;
use od_tools::scan::{ScanTimes, scan};
use od_wire::{Frame, Instant, NodeId};

use crate::id;
use crate::late::Late;

/// An encoder that supports LSS.
fn encoder(serial: u32, node_id: Option<NodeId>) -> VirtualDevice {
    let eds = od_devices::text::eds(od_devices::find("gxmm").expect("a built-in device"));
    let options = EdsOptions {
        node_id,
        lenient: true,
    };
    let (device, findings) = VirtualDevice::read_eds(&eds, options);
    device
        .unwrap_or_else(|| panic!("{findings:?}"))
        .with_serial_number(serial)
}

/// New encoders, with these serial numbers.
fn new(serials: &[u32]) -> Bus {
    let mut bus = Bus::new();
    for serial in serials {
        let device = bus.add(encoder(*serial, None).without_node_id().expect("LSS"));
        bus.start(device);
    }
    bus
}

#[test]
fn three_new_encoders_get_their_node_ids() {
    let serials = [4711, 4712, 0x8000_0001];
    let mut bus = new(&serials);
    assert!(
        scan(&mut OnBench(&mut bus), ScanTimes::default(), |_| {})
            .expect("a link")
            .has_unconfigured
    );
    let mut told = 0;
    let mut found = Lss::new(OnBench(&mut bus))
        .scan(|_| told += 1)
        .expect("a scan");
    found.sort();
    assert_eq!(
        found.iter().map(|one| one.serial).collect::<Vec<_>>(),
        serials
    );
    assert_eq!(told, 3);
    for (slave, node) in found.iter().zip([5, 6, 7]) {
        let mut lss = Lss::new(OnBench(&mut bus));
        assert_eq!(lss.set_node_id(*slave, id(node), true), Ok(true));
    }
    for (serial, node) in serials.iter().zip([5, 6, 7]) {
        let mut master = Master::new(OnBench(&mut bus), id(node));
        let read = master.upload(Address::new(0x1018, 4));
        assert_eq!(read, Ok(serial.to_le_bytes().to_vec()));
    }
    assert_eq!(Lss::new(OnBench(&mut bus)).scan(|_| {}), Ok(Vec::new()));
    // It was stored.
    for device in 0..3 {
        bus.set_power(device, false);
        bus.set_power(device, true);
    }
    let found = scan(&mut OnBench(&mut bus), ScanTimes::default(), |_| {}).expect("a link");
    assert_eq!(
        found
            .nodes
            .iter()
            .map(|one| one.node.raw())
            .collect::<Vec<_>>(),
        [5, 6, 7]
    );
}

#[test]
fn a_slave_with_a_node_id_changes_it_at_its_reset() {
    let mut bus = Bus::new();
    let device = bus.add(encoder(7, Some(id(5))));
    bus.start(device);
    let identity = Identity::new(bus.devices()[0].lss_address());
    let mut lss = Lss::new(OnBench(&mut bus));
    assert_eq!(lss.set_node_id(identity, id(9), false), Ok(false));
    drop(lss);
    let unknown = Identity {
        serial: 99,
        ..identity
    };
    let mut lss = Lss::new(OnBench(&mut bus));
    let nobody = lss.set_node_id(unknown, id(9), false);
    assert!(
        matches!(&nobody, Err(Error::Node(why)) if why.contains("99")),
        "{nobody:?}"
    );
}

#[test]
fn bit_rates_are_configured_for_one_or_all() {
    let mut bus = new(&[1, 2]);
    let mut lss = Lss::new(OnBench(&mut bus));
    assert_eq!(lss.set_bit_rate(Slaves::All, 250, true, None), Ok(()));
    let found = lss.scan(|_| {}).expect("a scan");
    assert_eq!(
        lss.set_bit_rate(Slaves::One(found[0]), 125, true, None),
        Ok(())
    );
    assert_eq!(lss.store(Slaves::All), Ok(()));
    let unknown = lss.set_bit_rate(Slaves::All, 33, true, None);
    assert!(matches!(unknown, Err(Error::Usage(_))), "{unknown:?}");
}

/// A link that is interrupted after a number of frames, and the frames that it sent.
struct Cut<'b> {
    bench: OnBench<&'b mut Bus>,
    left: u32,
    sent: Vec<Frame>,
}

impl Link for Cut<'_> {
    fn now(&self) -> Instant {
        self.bench.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.sent.push(*frame);
        self.bench.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        match self.left.checked_sub(1) {
            Some(left) => self.left = left,
            None => return Err(Error::Interrupted),
        }
        self.bench.receive(until)
    }
}

#[test]
fn an_interrupted_scan_leaves_no_slave_in_configuration_state() {
    for left in [1, 40, 300] {
        let mut bus = new(&[4711, 4712]);
        let mut cut = Cut {
            bench: OnBench(&mut bus),
            left,
            sent: Vec::new(),
        };
        assert_eq!(Lss::new(&mut cut).scan(|_| {}), Err(Error::Interrupted));
        let last = cut.sent.last().map(Frame::to_string);
        assert_eq!(last.as_deref(), Some("7E5#0400000000000000"));
    }
}

#[test]
fn a_late_response_restarts_the_search() {
    // The first request, a bit, the end of a number, the end of the last number, and the next
    // slave.
    for which in [1, 2, 20, 118, 119, 140] {
        for millis in [49, 60, 190] {
            let mut bus = new(&[4711, 4712]);
            let mut answers = 0;
            let late = Late::new(OnBench(&mut bus), |_| {
                answers += 1;
                if answers == which { millis } else { 0 }
            });
            let mut found = Lss::new(late).scan(|_| {}).expect("a scan");
            found.sort();
            let serials: Vec<_> = found.iter().map(|one| one.serial).collect();
            assert_eq!(serials, [4711, 4712], "answer {which}, {millis} ms late");
        }
    }
}

#[test]
fn an_interrupted_transfer_is_aborted() {
    let mut bus = crate::bus(&[("gxmm", 5)]);
    let mut cut = Cut {
        bench: OnBench(&mut bus),
        left: 1,
        sent: Vec::new(),
    };
    let mut master = Master::new(&mut cut, id(5));
    // The frame that is left is discarded before the request.
    assert_eq!(
        master.upload(Address::new(0x1008, 0)),
        Err(Error::Interrupted)
    );
    let last = cut.sent.last().map(Frame::to_string);
    assert!(
        last.as_ref().is_some_and(|last| last.starts_with("605#80")),
        "{last:?}"
    );
}

#[test]
fn a_slave_is_asked_for_its_address_and_node_id() {
    let mut bus = new(&[4711]);
    let (identity, node) = Lss::new(OnBench(&mut bus))
        .inquire(Slaves::All)
        .expect("a slave");
    assert_eq!((identity.serial, node), (4711, None));
    let other = bus.add(encoder(4712, NodeId::new(5)));
    bus.start(other);
    let several = Lss::new(OnBench(&mut bus)).inquire(Slaves::All);
    assert!(matches!(several, Err(Error::Node(why)) if why.contains("several")));
    let one = Identity {
        serial: 4712,
        ..identity
    };
    let asked = Lss::new(OnBench(&mut bus)).inquire(Slaves::One(one));
    assert_eq!(asked, Ok((one, NodeId::new(5))));
}

/// A slave that confirms each request of a fastscan.
struct ConfirmsAll {
    now: Instant,
    waiting: Vec<Heard>,
}

impl Link for ConfirmsAll {
    fn now(&self) -> Instant {
        self.now
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        if frame.id().as_standard() == Some(0x7E5) && frame.bytes()[0] == 0x51 {
            self.waiting.push(Heard {
                at: self.now.plus_millis(1),
                frame: Frame::standard(0x7E4, &[0x4F, 0, 0, 0, 0, 0, 0, 0]),
            });
        }
        Ok(())
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        if self.waiting.is_empty() {
            self.now = self.now.max(until);
            return Ok(None);
        }
        let heard = self.waiting.remove(0);
        self.now = self.now.max(heard.at);
        Ok(Some(heard))
    }
}

/// A slave responds only if its LSS address fits (CiA 305, chapter 6.7).
#[test]
fn a_slave_that_confirms_everything_is_not_found_again_and_again() {
    let bus = ConfirmsAll {
        now: Instant::ZERO,
        waiting: Vec::new(),
    };
    let mut told = 0;
    let found = Lss::new(bus).scan(|_| told += 1);
    assert!(
        matches!(&found, Err(Error::Node(why)) if why.contains("confirms each request")),
        "{found:?}"
    );
    assert_eq!(told, 0);
}
