//! The node as a static, its time, and changes of its values.

mod support;

use std::sync::Mutex;

use odkit::board::{Clock, Owner};
use odkit::storage::Memory;
use odkit::{Instant, Node, NodeId, Services};
use support::{Heater, frame, sent, thermometer};

type Thermometer = thermometer::Node<Heater, Memory<[u8; 256]>>;

static NODE: Mutex<Thermometer> = Mutex::new(Thermometer::new(
    thermometer::Device,
    NodeId::ONE,
    Heater::new(),
    Memory::new([0; 256]),
));

#[test]
fn a_node_is_a_static_and_sends_what_changes() {
    let mut node = NODE.lock().expect("one test has it");
    let now = Instant::ZERO;
    node.power_on(now);
    assert_eq!(sent(&mut *node, now), ["701#00"]);
    node.handle_frame(now, &frame("000#0100"));
    assert_eq!(sent(&mut *node, now), ["181#D700"]);
    node.set(now, thermometer::TEMPERATURE, 220);
    assert_eq!(sent(&mut *node, now), ["181#DC00"]);
    assert_eq!(node.get(thermometer::TEMPERATURE), 220);
    let ticks = node.change(now, |heater, store| {
        store.set(thermometer::TEMPERATURE, 221);
        heater.ticks
    });
    assert_eq!(ticks, 2);
    assert_eq!(node.application.ticks, 3);
    assert_eq!(sent(&mut *node, now), ["181#DD00"]);
    // A master's value.
    node.handle_frame(now, &frame("201#0500"));
    assert_eq!(node.get(thermometer::TARGET), 5);
}

#[test]
fn a_node_saves_and_loads() {
    let now = Instant::ZERO;
    let mut node = Thermometer::new(
        thermometer::Device,
        NodeId::ONE,
        Heater::new(),
        Memory::new([0; 256]),
    );
    node.power_on(now);
    node.handle_frame(now, &frame("601#2B17100064000000"));
    node.handle_frame(now, &frame("601#2310100173617665"));
    let answers = ["701#00", "581#6017100000000000", "581#6010100100000000"];
    assert_eq!(sent(&mut node, now), answers);
    let mut again = Thermometer::new(
        thermometer::Device,
        NodeId::ONE,
        Heater::new(),
        node.storage,
    );
    again.power_on(now);
    assert_eq!(again.poll_timeout(), Some(Instant::from_millis(100)));
}

/// Heartbeats with a counter of 32 bits that begins shortly before it wraps, and with a counter of
/// another frequency.
#[test]
fn heartbeats_continue_when_the_counter_wraps() {
    fn run<const HZ: u32, const BITS: u32>(first: u32, millis: u64) -> Vec<u64> {
        let mut clock = Clock::<HZ, BITS>::new();
        let memory = Memory::new([0; 256]);
        let mut node = Node::new(thermometer::Device, NodeId::ONE, Heater::new(), memory);
        let start = clock.at(first);
        node.power_on(start);
        node.handle_frame(start, &frame("601#2B17100064000000"));
        sent(&mut node, start);
        let mut beats = Vec::new();
        for milli in 0..millis {
            let passed = milli * u64::from(HZ) / 1000;
            let ticks = first.wrapping_add(passed as u32);
            let now = clock.at(ticks & u32::MAX >> (32 - BITS));
            node.catch_up(now);
            let frames = sent(&mut node, now);
            beats.extend(frames.iter().map(|_| milli));
        }
        beats
    }
    let expected: Vec<u64> = (1..20).map(|beat| beat * 100).collect();
    assert_eq!(run::<1_000_000, 32>(u32::MAX - 450_000, 2000), expected);
    assert_eq!(run::<1_000, 32>(u32::MAX - 450, 2000), expected);
    assert_eq!(run::<72_000_000, 32>(u32::MAX - 30_000_000, 2000), expected);
    // SysTick: it wraps four times.
    assert_eq!(run::<32_000_000, 24>(0xFF_0000, 2000), expected);
}

#[test]
fn no_tick_is_lost_in_sixty_days() {
    // 32,768 Hz: 30.5 µs per tick, read every few ticks.
    let mut clock = Clock::<32_768>::new();
    let (mut ticks, mut now) = (0u64, Instant::ZERO);
    while ticks < 60 * 86_400 * 32_768 {
        ticks += 1_000_003;
        now = clock.at(ticks as u32);
    }
    let exact = u128::from(ticks) * 1_000_000 / 32_768;
    assert_eq!(u128::from(now.as_micros()), exact);
    assert_eq!(Clock::<1_000>::LONGEST.as_secs(), (1 << 31) / 1000);
    assert!(thermometer::Device::DICTIONARY.is_some());
}
