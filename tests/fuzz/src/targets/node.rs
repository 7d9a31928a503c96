//! A whole device: frames, time, power, shaft, switches, faults and events of the CAN controller in any order.
//! It never panics, never floods the bus, sends nothing in Stopped that is not allowed, has no value outside its
//! limits, and works again after it was repaired and power-cycled.

use od_model::{Entry, Kind};
use od_runtime::{Frame, Instant};
use od_sim::{Bus, VirtualDevice};
use od_wire::nmt::State;

use super::bench::{self, Act, STEP};
use crate::harness::trace;
use crate::random::Random;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "node",
    run,
    make: Some(make),
    ..Target::PLAIN
};

fn make(random: &mut Random) -> Vec<u8> {
    let mut input = vec![0; STEP];
    input[0] = random.below(bench::kinds()) as u8;
    for _ in 0..random.below(400) {
        let halves = [random.next(), random.next()].map(u64::to_le_bytes);
        input.extend_from_slice(&halves.concat()[..STEP]);
    }
    input
}

fn run(input: &[u8]) {
    let Some(head) = input.first_chunk::<STEP>() else {
        return;
    };
    let device = bench::device(usize::from(head[0]));
    let entries = device.dictionary().entries().collect::<Vec<_>>();
    let faults: Vec<&str> = device.faults();
    let mut bus = play(input, device);
    for entry in entries {
        let value = bus.with(0, |device, now| device.read(entry.address, now));
        let node = bus.devices()[0].node_id().raw();
        within_limits(&entry, &value.unwrap_or_default(), node);
    }
    recovers(&mut bus, &faults);
}

/// Carries out the steps of an input on a device; the first step selects the device and is
/// not counted.
pub fn play(input: &[u8], device: VirtualDevice) -> Bus {
    let entries = device.dictionary().entries().collect::<Vec<_>>();
    let faults: Vec<&str> = device.faults();
    let mut bus = Bus::new();
    bus.add(device);
    bus.start(0);
    for step in input.chunks_exact(STEP).skip(1) {
        let step = step.try_into().expect("chunks are that long");
        let node = bus.devices()[0].node_id().raw();
        let before = bus.devices()[0].state();
        let act = bench::act(step, &entries, node);
        trace(|| format!("> {act:?}"));
        match act {
            Act::Frame(frame) => {
                bus.receive(&frame);
                quiet(&mut bus, Some(&frame), before);
            }
            Act::Time(micros) => pass(&mut bus, micros),
            Act::Power(micros) => {
                bus.with(0, VirtualDevice::power_off);
                pass(&mut bus, micros);
                bus.set_power(0, true);
            }
            Act::Position(raw) => drop(bus.with(0, |device, now| device.set_position(raw, now))),
            Act::Rpm(rpm) => drop(bus.with(0, |device, now| device.set_rpm(rpm, now))),
            Act::Turn(turns) => drop(bus.with(0, |device, now| device.turn(turns, now))),
            Act::Switches(id, rate) => {
                bus.with(0, |device, now| {
                    device.set_node_switch(id, now);
                    device.set_bitrate_switch(rate, now);
                });
            }
            Act::Fault(number, broken) => {
                if let Some(name) = faults.get(number % faults.len().max(1)) {
                    bus.with(0, |device, now| device.set_fault(name, broken, now));
                }
            }
            Act::Cut(bytes) => drop(bus.with(0, |device, _| device.cut_power_after(bytes))),
            Act::Controller(event) => {
                bus.with(0, |device, now| device.handle_bus(event, now));
            }
        }
        // Frames caused by inputs of the application are not the response to the next frame.
        quiet(&mut bus, None, before);
        let device = &bus.devices()[0];
        // The visible state must exist at any moment.
        let _ = (device.leds(), device.shaft(bus.now()), device.bit_rate());
    }
    bus
}

/// An integer that a master may write is within its limits.
fn within_limits(entry: &Entry, value: &[u8], node: u8) {
    let is_integer = matches!(entry.data_type.kind(), Kind::Unsigned | Kind::Signed);
    let Some(unused) = 8_u32.checked_sub(value.len() as u32).map(|bytes| 8 * bytes) else {
        return;
    };
    if !is_integer || !entry.access.writable() || value.is_empty() {
        return;
    }
    let number = value
        .iter()
        .rev()
        .fold(0, |number, byte| number << 8 | u64::from(*byte));
    let number = match entry.data_type.kind() {
        Kind::Signed => i128::from((number << unused) as i64 >> unused),
        _ => i128::from(number),
    };
    let low = entry.low.integer(node).unwrap_or(i128::MIN);
    let high = entry.high.integer(node).unwrap_or(i128::MAX);
    assert!(
        (low..=high).contains(&number),
        "{} is {number}",
        entry.address
    );
}

/// One frame or input is followed by a few frames; in Stopped by
/// no SDO, PDO or EMCY.
fn quiet(bus: &mut Bus, frame: Option<&Frame>, before: State) {
    let after = bus.devices()[0].state();
    let cause = || frame.map_or("a change outside".to_string(), Frame::to_string);
    let mut count = 0;
    while let Some(sent) = bus.poll() {
        trace(|| format!("< {:?} {}", sent.at, sent.frame));
        count += 1;
        if before == State::Stopped && after == State::Stopped {
            let about_lss = frame.is_some_and(|frame| frame.id().as_standard() == Some(0x7E5));
            assert!(
                about_lss || frame.is_some_and(Frame::is_remote),
                "stopped, it answers {} with {}",
                cause(),
                sent.frame
            );
        }
    }
    // A block of 127 segments is the longest response.
    assert!(count <= 140, "{count} answers to {}", cause());
}

fn pass(bus: &mut Bus, micros: u64) {
    let start = bus.now();
    let end = start.plus_micros(micros);
    bus.advance(end);
    let mut count = 0_u64;
    while let Some(sent) = bus.poll() {
        count += 1;
        assert!(
            sent.at >= start && sent.at <= end,
            "{} is sent at {:?}",
            sent.frame,
            sent.at
        );
    }
    // A heartbeat, EMCY, and a PDO each, once a millisecond each, with their repetitions.
    let most = 200 + micros / 1000 * 70;
    assert!(count <= most, "{count} frames in {micros} us");
}

fn recovers(bus: &mut Bus, faults: &[&str]) {
    bus.with(0, |device, now| {
        device.power_off(now);
        for name in faults {
            device.set_fault(name, false, now);
        }
        device.set_rpm(0.0, now);
        device.set_node_switch(0, now);
        device.set_bitrate_switch(0, now);
    });
    pass(bus, 60_000_000);
    bus.start(0);
    let from = bus.now();
    bus.advance(from.plus_millis(5000));
    let node = u16::from(bus.devices()[0].node_id().raw());
    let mut boots = 0;
    while let Some(sent) = bus.poll() {
        let boot = Frame::standard(0x700 + node, &[0]);
        boots += usize::from(sent.frame == boot);
    }
    let state = bus.devices()[0].state();
    // Without a node ID it waits for LSS; a node that starts without a master is Operational.
    if state == State::Initialising {
        return;
    }
    assert_eq!(
        boots, 1,
        "boot-up messages of node {node} after a power cycle, {state}"
    );
    // Saved values may put the device into any state at its start; the test requests this one.
    bus.receive(&Frame::standard(0, &[0x80, node as u8]));
    while bus.poll().is_some() {}
    bus.receive(&Frame::standard(
        0x600 + node,
        &[0x40, 0, 0x10, 0, 0, 0, 0, 0],
    ));
    let answer = std::iter::from_fn(|| bus.poll())
        .find(|sent| sent.frame.bytes()[..4] == [0x43, 0, 0x10, 0]);
    assert!(
        answer.is_some(),
        "node {node} does not say what it is, {:?}",
        bus.devices()[0].state()
    );
    debug_assert!(bus.now() > Instant::ZERO);
}
