//! A recorded device responds as the original did.

use od_model::Address;
use od_sim::bus::Bus;
use od_sim::recorded::{Recorded, read};
use od_sim::{EdsOptions, VirtualDevice};
use od_tools::bench::OnBench;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::Record;
use od_tools::conform::session::{Permissions, Session};
use od_tools::learn::record::{Watch, record};
use od_tools::learn::{Options, learn};
use od_tools::link::Link;
use od_tools::master::Master;
use od_wire::{Duration, Frame, Instant, NodeId};

use crate::simulated::{alone, bus};

const START: Frame = Frame::standard(0, &[1, 1]);
const RESET: Frame = Frame::standard(0, &[0x81, 1]);
const POSITION: Address = Address::new(0x6004, 0);

/// A GXMM that turns, in Operational, with a heartbeat every 200 ms and TPDO1 every 40 ms.
fn original() -> Bus {
    let mut bus = bus("gxmm");
    bus.with(0, |device, now| device.set_rpm(30.0, now));
    let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
    for (index, sub, value) in [(0x1017, 0, 200u16), (0x1800, 5, 40)] {
        let written = master.download(Address::new(index, sub), &value.to_le_bytes());
        written.expect("a value");
    }
    bus.receive(&START);
    bus
}

/// The text of an EDS with a recording.
fn recorded(bus: &mut Bus, reset: bool) -> String {
    let made = learn(OnBench(&mut *bus), NodeId::ONE, Options::default(), |_| {}).expect("a node");
    let made = made.description;
    let watch = Watch {
        length: Duration::from_secs(2),
        reset,
    };
    let seen = record(OnBench(bus), NodeId::ONE, &made, watch).expect("a node");
    assert!(
        seen.lacking
            .iter()
            .any(|one| one.contains("state machines"))
    );
    format!("{}\n{}", od_eds::write(&made), seen.recorded)
}

/// A device that plays the recording, just switched on.
fn twin(text: &str) -> (Bus, Recorded) {
    let (device, findings) = VirtualDevice::read_eds(text, EdsOptions::default());
    let mut device = device.unwrap_or_else(|| panic!("{findings:?}"));
    let recorded = read(text).expect("valid lines").expect("a recording");
    device.play_recorded(recorded.clone());
    (alone(device), recorded)
}

/// The times of the frames with a CAN-ID, within a second.
fn moments(bus: &mut Bus, id: u16) -> Vec<Instant> {
    let mut link = OnBench(bus);
    let until = link.now() + Duration::from_secs(1);
    let mut all = Vec::new();
    while let Some(heard) = link.receive(until).expect("a bus") {
        if heard.frame.id().as_standard() == Some(id) {
            all.push(heard.at);
        }
    }
    all
}

#[test]
fn reads_periods_and_boot_up_equal_those_of_the_original() {
    let mut original = original();
    let text = recorded(&mut original, false);
    let (mut twin, recorded) = twin(&text);
    assert_eq!(recorded.heartbeat, Some(200_000), "{text}");
    assert_eq!(recorded.tpdos.get(&1), Some(&40_000));
    // It turns as the original did.
    let positions: Vec<&Vec<u8>> = recorded
        .values
        .iter()
        .filter(|(_, address, _)| *address == POSITION)
        .map(|(_, _, bytes)| bytes)
        .collect();
    assert!(positions.len() > 30, "{} positions", positions.len());
    let mut shown = Vec::new();
    for _ in 0..10 {
        let now = twin.now();
        twin.advance(now.plus_millis(100));
        let mut master = Master::new(OnBench(&mut twin), NodeId::ONE);
        let bytes = master.upload(POSITION).expect("a value");
        assert!(positions.contains(&&bytes), "{bytes:?}");
        shown.push(bytes);
    }
    shown.dedup();
    assert_eq!(shown.len(), 10, "{shown:?}");
    // Constant values are the same, and so are aborts; only the counter 2201h differs.
    let eds = Eds::read(&text);
    let changes = |address| {
        recorded
            .values
            .iter()
            .any(|(_, other, _)| *other == address)
    };
    for entry in eds.dictionary().entries() {
        let is_fixed = !changes(entry.address) && entry.address.index != 0x2201;
        if entry.access.readable() && is_fixed {
            let [right, got] = [&mut original, &mut twin]
                .map(|bus| Master::new(OnBench(bus), NodeId::ONE).upload(entry.address));
            assert_eq!(right, got, "{}", entry.address);
        }
    }
    for id in [0x701, 0x181] {
        twin.receive(&START);
        let [right, got] = [&mut original, &mut twin].map(|bus| moments(bus, id));
        let gaps = |all: &[Instant]| -> Vec<u64> {
            all.windows(2)
                .map(|two| two[1].micros_since(two[0]))
                .collect()
        };
        assert!(right.len() > 3, "{id:03X}");
        assert_eq!(gaps(&right)[..3], gaps(&got)[..3], "{id:03X}");
    }
}

#[test]
fn a_start_equals_that_of_the_original() {
    let mut original = original();
    let text = recorded(&mut original, true);
    let (mut twin, recorded) = twin(&text);
    let boot = |bus: &mut Bus| {
        let mut link = OnBench(bus);
        let from = link.now();
        link.send(&RESET).expect("a bus");
        let until = from + Duration::from_secs(5);
        loop {
            let heard = link
                .receive(until)
                .expect("a bus")
                .expect("a boot-up message");
            if heard.frame.to_string() == "701#00" {
                return heard.at.micros_since(from);
            }
        }
    };
    let right = boot(&mut original);
    assert_eq!(recorded.boot_up, Some(right));
    assert_eq!(boot(&mut twin), right);
}

#[test]
fn recorded_times_errors_and_aborts_are_played() {
    let mut original = original();
    let text = recorded(&mut original, false)
        .replace(";twin answer 0ms", ";twin answer 3ms")
        .replace(";twin heartbeat 200ms", ";twin heartbeat 180ms")
        + ";twin emcy 20ms 8130h 11h 01 02 03 04 05\n;twin abort 6500h:00 08000022h\n";
    let (mut bus, _) = twin(&text);
    let mut link = OnBench(&mut bus);
    let mut emcy = None;
    while let Some(heard) = link.receive(Instant::ZERO.plus_millis(50)).expect("a bus") {
        if heard.frame.to_string() == "081#3081110102030405" {
            emcy = Some(heard.at.micros_since(Instant::ZERO));
        }
    }
    assert_eq!(emcy, Some(20_000));
    let mut master = Master::new(&mut link, NodeId::ONE);
    let from = master.link().now();
    let refused = master.upload(Address::new(0x6500, 0));
    assert_eq!(refused, Err(od_tools::Error::Abort(0x0800_0022)));
    assert_eq!(master.link().now().micros_since(from), 3_000);
    let beats = moments(&mut bus, 0x701);
    let gaps = beats.windows(2).map(|two| two[1].micros_since(two[0]));
    assert!(beats.len() >= 4, "{beats:?}");
    assert!(gaps.into_iter().all(|gap| gap == 180_000), "{beats:?}");
    // Without a configured heartbeat the node sends none.
    let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
    let off = master.download(Address::new(0x1017, 0), &[0, 0]);
    off.expect("a value");
    assert_eq!(moments(&mut bus, 0x701), []);
}

#[test]
fn the_verdicts_equal_those_of_the_original() {
    let text = recorded(&mut original(), false);
    let eds = Eds::read(&text);
    let verdicts = |bus: Bus| {
        let mut rig = OnBench(bus);
        let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::default());
        let cases = built_in()
            .iter()
            .filter(|case| ["EDS", "SDO", "objects", "TIME"].contains(&case.group.as_str()))
            // The original has LSS in Stopped, where a recorder does not put a node.
            .filter(|case| case.id != "eds-lss");
        cases
            .map(|case| session.run(case))
            .map(|Record { id, verdict, .. }| format!("{id}: {}", verdict.word()))
            .collect::<Vec<_>>()
    };
    let right = verdicts(original());
    assert!(right.iter().filter(|one| one.ends_with("pass")).count() > 30);
    assert_eq!(right, verdicts(twin(&text).0));
}
