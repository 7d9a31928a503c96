//! Times on a line that takes time, against a calculation by hand.

use std::format;

use od_devices::DEVICES;
use od_runtime::NodeId;

use super::*;
use crate::device::VirtualDevice;
use crate::line::FrameError;
use crate::logs::candump::parse_frame;

/// A bus at this bit rate in kbit/s with encoders of these node IDs.
fn bus(kbit: u16, nodes: &[u8]) -> Bus {
    let mut bus = Bus::new();
    bus.line.set_real(true);
    for node in nodes {
        let id = NodeId::new(*node).expect("1 to 127");
        let mut device = VirtualDevice::new(&DEVICES[0], id);
        device.set_up_for(Some(kbit));
        let number = bus.add(device);
        bus.start(number);
    }
    bus
}

fn send(bus: &mut Bus, text: &str) {
    bus.receive(&parse_frame(text).expect(text));
}

/// All frames transmitted until `to`, with their microseconds.
fn seen(bus: &mut Bus, to: u64) -> Vec<(u64, String)> {
    let mut all = Vec::new();
    while bus.advance_until_sent(Instant::from_micros(to)) {
        while let Some(sent) = bus.poll() {
            all.push((sent.at.as_micros(), format!("{}", sent.frame)));
        }
    }
    all
}

/// Bits of ten frames with their stuff bits, without the three bits between frames: 44 or 64, plus
/// 8 per byte, plus the stuff bits, which were counted by hand.
const BY_HAND: [(&str, u64); 10] = [
    ("000#0105", 44 + 16 + 7),
    ("080#", 44 + 4),
    ("123#0000000000000000", 44 + 64 + 14),
    ("123#FFFFFFFFFFFFFFFF", 44 + 64 + 13),
    ("2A5#55AA", 44 + 16 + 2),
    ("605#4004600000000000", 44 + 64 + 12),
    ("7E5#0401000000000000", 44 + 64 + 12),
    ("18FF50E5#0102", 64 + 16 + 5),
    ("00000000#00", 64 + 8 + 8),
    ("705#R", 44 + 2),
];

#[test]
fn ten_frames_take_the_bits_of_a_calculation_by_hand() {
    for kbit in [10, 50, 125, 500, 800, 1000] {
        let mut bus = bus(kbit, &[127]);
        let _ = seen(&mut bus, 100_000);
        for (text, _) in BY_HAND {
            send(&mut bus, text);
        }
        let came = seen(&mut bus, 1_000_000);
        assert_eq!(came.len(), 10, "{kbit} kbit/s: {came:?}");
        let mut bits = 0;
        for ((text, own), (at, frame)) in BY_HAND.iter().zip(came) {
            bits += own;
            let hand = 100_000.0 + bits as f64 * 1000.0 / f64::from(kbit);
            let bit = 1000.0 / f64::from(kbit);
            assert!(
                (at as f64 - hand).abs() <= bit,
                "{text} at {kbit} kbit/s: {at}, by hand {hand}"
            );
            assert_eq!(parse_frame(text).map(|frame| frame.to_string()), Ok(frame));
            bits += 3;
        }
    }
}

#[test]
fn a_response_arrives_after_its_processing_time_and_its_bits() {
    let mut bus = bus(500, &[127]);
    let _ = seen(&mut bus, 10_000);
    send(&mut bus, "67F#4000100000000000");
    let came = seen(&mut bus, 20_000);
    let request = 10_000 + 2 * (44 + 64 + 12);
    let answer = request + PROCESSING + 2 * (44 + 64 + 8);
    let at: Vec<_> = came.iter().map(|(at, _)| *at).collect();
    assert_eq!(at, [request, answer], "{came:?}");
    assert_eq!(came[1].1, "5FF#4300100096010200");
}

#[test]
fn of_the_waiting_frames_the_lowest_identifier_is_sent_first() {
    let mut bus = bus(50, &[3, 1, 2]);
    send(&mut bus, "080#");
    let came = seen(&mut bus, 100_000);
    let order: Vec<_> = came.iter().map(|(_, frame)| frame.as_str()).collect();
    // Node 3 began while the line was idle; the others waited for it.
    assert_eq!(order[1..], ["701#00", "702#00", "703#00"], "{came:?}");
    for two in came.windows(2) {
        assert!(two[1].0 - two[0].0 >= (44 + 8 + 3) * 20, "{came:?}");
    }
}

#[test]
fn the_load_ends_at_100_percent_and_low_priorities_starve() {
    let mut bus = bus(50, &[1, 2, 3]);
    let _ = seen(&mut bus, 100_000);
    for node in 1..=3 {
        send(&mut bus, &format!("60{node}#2B00180501000000"));
    }
    let _ = seen(&mut bus, 200_000);
    send(&mut bus, "000#0100");
    let _ = seen(&mut bus, 300_000);
    let before = bus.line.busy();
    let came = seen(&mut bus, 1_300_000);
    let busy = bus.line.busy() - before;
    assert!(
        (990_000..=1_003_000).contains(&busy),
        "{busy} us of a second"
    );
    let count = |id: &str| {
        came.iter()
            .filter(|(_, frame)| frame.starts_with(id))
            .count()
    };
    assert!(count("181") > 300, "{}", count("181"));
    assert_eq!(count("183"), 0);
}

#[test]
fn a_lone_node_repeats_without_end_and_is_error_passive() {
    let mut bus = bus(500, &[1]);
    bus.line.set_plugged(0, false);
    assert_eq!(seen(&mut bus, 5_000_000), []);
    let lost: Vec<_> = core::iter::from_fn(|| bus.line.poll()).collect();
    assert!(
        lost.iter()
            .all(|one| one.error == FrameError::NoAcknowledge && !one.bus_off)
    );
    // Each attempt until error passive is reported, then one per second.
    let counters: Vec<_> = lost.iter().map(|one| one.transmit_errors).collect();
    let climb: Vec<u16> = (1..=16).map(|attempt| 8 * attempt).collect();
    assert_eq!(counters[..16], climb);
    assert_eq!(counters[16..], [128; 4]);
    // Each attempt: 56 bits without the 8 after the acknowledge slot, 14 of an error frame, 3
    // between frames.
    let bits = 16 * (56 - 8 + 14 + 3) - 3;
    assert_eq!(lost[15].at.as_micros(), 2 * bits);
    // From then on the node also suspends its transmission for 8 bits.
    let (last, before) = (&lost[19], &lost[15]);
    let time = last.at.micros_since(before.at);
    let one = 2 * (56 - 8 + 14 + 3 + 8);
    assert!(time > 4_000_000, "{time}");
    assert_eq!(
        u64::from(last.attempts - before.attempts),
        time.div_ceil(one)
    );
    // With another station on the line, the next attempt succeeds.
    bus.line.set_plugged(0, true);
    assert_eq!(seen(&mut bus, 5_001_000), [(5_000_226, "701#00".into())]);
    assert_eq!(bus.line.controller(1).transmit, 127);
}

#[test]
fn a_failed_frame_is_repeated_until_it_is_transmitted() {
    let mut bus = bus(1000, &[127]);
    bus.line.terminators = 1;
    bus.line.set_seed(1);
    let _ = seen(&mut bus, 10_000);
    while bus.line.poll().is_some() {}
    for _ in 0..100 {
        send(&mut bus, "123#00");
    }
    let came = seen(&mut bus, 1_000_000);
    let lost: Vec<_> = core::iter::from_fn(|| bus.line.poll()).collect();
    assert_eq!(came.len(), 100);
    assert!(
        lost.len() > 5 && lost.iter().all(|one| !one.bus_off),
        "{lost:?}"
    );
    // The next frame on the line is the same frame again.
    for one in lost {
        let next = came.iter().find(|(at, _)| *at > one.at.as_micros());
        assert_eq!(next.map(|(_, frame)| frame.as_str()), Some("123#00"));
    }
}

#[test]
fn two_nodes_with_one_node_id_send_one_frame_or_destroy_each_other() {
    let mut bus = bus(500, &[1]);
    let mut other = VirtualDevice::new(&DEVICES[0], NodeId::ONE).with_serial_number(2);
    other.set_up_for(Some(500));
    let other = bus.add(other);
    bus.start(other);
    assert_eq!(seen(&mut bus, 10_000).len(), 1, "one boot-up message");
    send(&mut bus, "601#4000100000000000");
    let came: Vec<_> = seen(&mut bus, 20_000)
        .into_iter()
        .map(|(_, frame)| frame)
        .collect();
    assert_eq!(came, ["601#4000100000000000", "581#4300100096010200"]);
    assert_eq!(bus.line.poll(), None, "equal responses disturb nobody");
    // The serial number differs.
    send(&mut bus, "601#4018100400000000");
    let came: Vec<_> = seen(&mut bus, 100_000)
        .into_iter()
        .map(|(_, frame)| frame)
        .collect();
    let lost: Vec<_> = core::iter::from_fn(|| bus.line.poll()).collect();
    assert_eq!(
        came.len(),
        3,
        "both responses, one after the other: {came:?}"
    );
    assert!(lost.iter().all(|one| one.error == FrameError::SameId));
    let of = |device| lost.iter().filter(|one| one.device == Some(device)).count();
    // 16 attempts of both, until one of them is error passive and cannot stop the other.
    assert_eq!((of(0).min(of(1)), of(0).max(of(1))), (16, 17), "{lost:?}");
    assert!((100..=128).contains(&bus.line.controller(1).transmit));
}

#[test]
fn frames_of_a_device_without_power_are_lost() {
    let mut bus = bus(10, &[1]);
    bus.set_power(0, false);
    assert_eq!(seen(&mut bus, 1_000_000), []);
    bus.set_power(0, true);
    assert_eq!(seen(&mut bus, 5_000_000).len(), 1);
}

/// The oldest frame of the outside waits a little longer because its controller is error passive. A second one
/// after it waits, too.
#[test]
fn two_frames_that_no_node_acknowledges_do_not_stop_time() {
    let mut bus = bus(500, &[5]);
    bus.set_power(0, false);
    send(&mut bus, "080#");
    send(&mut bus, "081#");
    let end = bus.now().plus_millis(20);
    seen(&mut bus, end.as_micros());
    assert_eq!(bus.now(), end);
    assert_eq!(bus.line.controller(0).transmit, 128);
    bus.set_power(0, true);
    let after = seen(&mut bus, end.as_micros() + 2_000_000);
    let own = after.iter().filter(|(_, frame)| frame.starts_with("08"));
    let own: Vec<&str> = own.map(|(_, frame)| frame.as_str()).collect();
    assert_eq!(own, ["080#", "081#"]);
}

/// Two devices repeat their boot-up messages, which no station acknowledges, on wires of their own (ISO 11898-1): the others
/// have the whole line, also with a frame of lower priority.
#[test]
fn a_device_that_is_not_connected_takes_no_time_of_the_line() {
    let mut bus = bus(500, &[1, 2, 9]);
    for station in [1, 2] {
        bus.line.set_plugged(station, false);
    }
    assert_eq!(seen(&mut bus, 400_000).len(), 1, "the boot-up of node 9");
    assert_eq!(bus.line.controller(2).transmit, 128);
    let (from, busy) = (bus.now().as_micros(), bus.line.busy());
    send(&mut bus, "7E5#0400000000000000");
    send(&mut bus, "609#4000100000000000");
    let all = seen(&mut bus, from + 20_000);
    assert_eq!(all.len(), 3, "{all:?}");
    assert_eq!(all[2].1, "589#4300100096010200");
    // Three frames of less than 135 bits, and the time of the device.
    assert!(all[2].0 - from < 3 * 135 * 2 + 1000, "{all:?}");
    assert!(bus.line.busy() - busy < 3 * 138 * 2);
    // Connected again, they send what they repeated.
    bus.line.set_plugged(1, true);
    let all = seen(&mut bus, from + 40_000);
    assert_eq!(all.len(), 1, "{all:?}");
    assert_eq!(all[0].1, "701#00");
}

#[test]
fn the_queue_of_the_outside_takes_no_more_than_a_thousand_frames() {
    let mut bus = bus(500, &[]);
    let frame = parse_frame("123#00").expect("a frame");
    let taken = (0..1200).filter(|_| bus.queue(&frame)).count();
    assert_eq!(taken, 1000);
}
