//! Values and frames over time: `watch` and `replay`.

use od_client::nmt;
use od_model::Address;
use od_sim::bus::Bus;
use od_tools::bench::OnBench;
use od_tools::link::Link;
use od_tools::master::Master;
use od_tools::replay::replay;
use od_tools::watch::{By, Sample, sources, watch};
use od_wire::nmt::Command;
use od_wire::{Duration, Frame, Instant};

use crate::{bus, id};

const NEVER: Instant = Instant::from_micros(u64::MAX);
const POSITION: Address = Address::new(0x6004, 0);
const OPERATING: Address = Address::new(0x6000, 0);

/// An encoder that sends its first TPDO every 50 ms.
fn running() -> Bus {
    let mut bus = bus(&[("gxmm", 5)]);
    let mut link = OnBench(&mut bus);
    let mut master = Master::new(&mut link, id(5));
    let timer = Address::new(0x1800, 5);
    assert_eq!(master.download(timer, &[50, 0]), Ok(()));
    drop(master);
    link.send(&nmt::frame(Some(id(5)), Command::Start))
        .expect("a link");
    bus
}

fn samples(bus: &mut Bus, millis: u64) -> Vec<Sample> {
    let mut link = OnBench(bus);
    let mut master = Master::new(&mut link, id(5));
    let sources = sources(&mut master, &[POSITION, OPERATING]).expect("a node");
    drop(master);
    assert!(matches!(
        sources[0].by,
        By::Pdo {
            number: 1,
            first: 0,
            bits: 32,
            ..
        }
    ));
    assert_eq!(sources[1].by, By::Poll);
    let until = link.now().plus_millis(millis);
    let mut all = Vec::new();
    let every = Duration::from_millis(200);
    let done = watch(&mut link, id(5), &sources, every, NEVER, |sample| {
        let goes_on = sample.at <= until;
        all.extend(goes_on.then_some(sample));
        goes_on
    });
    assert_eq!(done, Ok(()));
    all
}

#[test]
fn a_mapped_value_is_read_from_its_tpdo_and_others_are_polled() {
    let mut bus = running();
    let all = samples(&mut bus, 1000);
    let times = |source| {
        let own = all.iter().filter(|sample| sample.source == source);
        own.map(|sample| sample.at).collect::<Vec<_>>()
    };
    // One response at the beginning, then a TPDO every 50 ms.
    let mapped = times(0);
    assert!((20..=22).contains(&mapped.len()), "{mapped:?}");
    let polled = times(1);
    assert!((5..=6).contains(&polled.len()), "{polled:?}");
    assert!(
        polled
            .windows(2)
            .all(|two| two[1].micros_since(two[0]) == 200_000),
        "{polled:?}"
    );
    assert!(
        all.iter()
            .all(|sample| sample.value.as_ref().is_ok_and(|bytes| !bytes.is_empty()))
    );
}

#[test]
fn a_mapped_value_of_a_node_that_sends_no_tpdo_is_polled() {
    let mut bus = running();
    OnBench(&mut bus)
        .send(&nmt::frame(None, Command::EnterPreOperational))
        .expect("a link");
    let all = samples(&mut bus, 3500);
    let mapped = all.iter().filter(|sample| sample.source == 0).count();
    assert!((3..=4).contains(&mapped), "{mapped}");
}

#[test]
fn a_silent_node_is_reported_and_asked_again() {
    let mut bus = running();
    let mut link = OnBench(&mut bus);
    let source = od_tools::watch::Source {
        address: OPERATING,
        by: By::Poll,
        data_type: None,
    };
    let mut count = 0;
    let done = watch(
        &mut link,
        id(9),
        &[source],
        Duration::from_millis(200),
        NEVER,
        |sample| {
            assert_eq!(sample.value, Err(od_client::Error::Silent));
            count += 1;
            count < 3
        },
    );
    assert_eq!((done, count), (Ok(()), 3));
}

#[test]
fn a_log_keeps_its_timing() {
    let log: Vec<(Instant, Frame)> = [5000, 5010, 5250, 5250]
        .into_iter()
        .map(|at| (Instant::from_millis(at), Frame::standard(0x80, &[])))
        .collect();
    for (speed, took) in [(1.0, 250_000), (2.0, 125_000), (0.5, 500_000), (0.0, 0)] {
        let mut bus = bus(&[("gxmm", 5)]);
        let mut link = OnBench(&mut bus);
        let begin = link.now();
        assert_eq!(replay(&mut link, &log, speed), Ok(4));
        assert_eq!(link.now().micros_since(begin), took, "{speed}");
    }
}
