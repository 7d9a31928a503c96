//! The bench as its users see it: devices, bus, words.

mod commissioning;
mod long;
mod own;

use std::prelude::v1::*;
use std::{format, vec};

use od_model::Address;
use od_runtime::{Frame, Instant, NodeId};
use od_wire::nmt::State;

use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::device::leds::Led;
use crate::device::loaded::EdsOptions;
use crate::logs::candump;
use crate::words::Decoder;

const STRINGS: &str = include_str!("../../../tests/interop/strings.eds");

fn gxmm(node_id: u8) -> VirtualDevice {
    let kind = od_devices::find("gxmm").expect("a built-in device");
    VirtualDevice::new(kind, NodeId::new(node_id).expect("a node ID"))
}

fn bench(devices: Vec<VirtualDevice>) -> Bus {
    let mut bus = Bus::new();
    for device in devices {
        let number = bus.add(device);
        bus.with(number, VirtualDevice::power_on);
    }
    bus
}

fn frame(text: &str) -> Frame {
    candump::parse_frame(text).expect(text)
}

/// All frames on the bus since the last call.
fn heard(bus: &mut Bus) -> Vec<String> {
    std::iter::from_fn(|| bus.poll())
        .map(|sent| {
            candump::format_line(
                sent.at,
                &format!("dev{}", sent.device.expect("a device")),
                &sent.frame,
            )
        })
        .collect()
}

#[test]
fn deadlines_are_met_at_their_own_moment() {
    let mut bus = bench(vec![gxmm(1), gxmm(2)]);
    assert_eq!(
        heard(&mut bus),
        ["(0.000000) dev0 701#00", "(0.000000) dev1 702#00"]
    );
    bus.receive(&frame("602#2B17100064000000"));
    bus.receive(&frame(
        "601#2B1710009600000000".get(..20).expect("eight bytes"),
    ));
    heard(&mut bus);
    bus.advance(Instant::from_millis(310));
    assert_eq!(
        heard(&mut bus),
        [
            "(0.100000) dev1 702#7F",
            "(0.150000) dev0 701#7F",
            "(0.200000) dev1 702#7F",
            "(0.300000) dev0 701#7F",
            "(0.300000) dev1 702#7F",
        ]
    );
    assert_eq!(bus.now(), Instant::from_millis(310));
    assert!(bus.advance_until_sent(Instant::from_millis(1000)));
    assert_eq!(bus.now(), Instant::from_millis(400));
}

#[test]
fn a_compiled_device_runs_on_its_own_node() {
    use od_devices::en580c::en580c;
    let room = |device| {
        let mut bus = bench(vec![device]);
        heard(&mut bus);
        bus.receive(&frame("601#C217100002000000"));
        let frame = bus.poll().expect("an answer").frame;
        assert_eq!(frame.data()[..4], [0xA4, 0x17, 0x10, 0x00]);
        frame.data()[4]
    };
    let own = VirtualDevice::of("own", en580c::Device, NodeId::ONE);
    let segments = en580c::DICTIONARY.longest() / 7;
    assert_eq!(usize::from(room(own)), segments.max(1));
    let options = EdsOptions {
        node_id: Some(NodeId::ONE),
        lenient: false,
    };
    let loaded = VirtualDevice::from_eds(STRINGS, options);
    assert_eq!(room(loaded.expect("a device")), 127);
}

#[test]
fn devices_receive_each_other() {
    let mut bus = bench(vec![gxmm(1), gxmm(5)]);
    heard(&mut bus);
    // The first monitors the second, whose heartbeat then stops with its power.
    bus.receive(&frame("601#23161001C8000500"));
    bus.receive(&frame("605#2B17100064000000"));
    bus.advance(Instant::from_millis(450));
    bus.with(1, VirtualDevice::power_off);
    heard(&mut bus);
    bus.advance(Instant::from_millis(2000));
    assert_eq!(heard(&mut bus), ["(0.600000) dev0 081#3081110000000000"]);
}

#[test]
fn values_are_read_without_traffic() {
    let mut bus = bench(vec![gxmm(1)]);
    heard(&mut bus);
    bus.with(0, |device, now| device.set_rpm(60.0, now));
    bus.advance(Instant::from_millis(1000));
    let value = bus.with(0, |device, now| device.read(Address::new(0x6004, 0), now));
    assert_eq!(value.as_deref(), Some(&[0, 0x20, 0, 0][..]));
    let text = bus.with(0, |device, now| device.read(Address::new(0x1008, 0), now));
    assert_eq!(text.as_deref(), Some(&b"GXMM"[..]));
    let none = bus.with(0, |device, now| device.read(Address::new(0x2000, 0), now));
    assert_eq!(none.as_deref(), Some(&[][..]));
    assert!(heard(&mut bus).is_empty());
    let shaft = bus.devices()[0].shaft(bus.now()).expect("a shaft");
    assert_eq!((shaft.turns, shaft.rpm, shaft.raw), (1.0, 60.0, 0x2000));
}

#[test]
fn leds_show_the_state() {
    let mut device = gxmm(1);
    assert_eq!(device.leds(), (Led::Off, Led::Off));
    device.power_on(Instant::ZERO);
    assert_eq!(device.leds(), (Led::Flashing, Led::Off));
    device.set_fault("battery-low", true, Instant::ZERO);
    assert_eq!(device.leds(), (Led::Flashing, Led::Flashing));
    assert!(device.is_broken("battery-low") && !device.set_fault("fire", true, Instant::ZERO));
}

#[test]
fn an_eds_is_a_device_and_other_text_is_not() {
    let device = VirtualDevice::from_eds(STRINGS, EdsOptions::default());
    let device = device.expect("a device");
    assert_eq!(
        (device.title(), device.state()),
        ("Transfers", State::Initialising)
    );
    let mut bus = bench(vec![device]);
    assert_eq!(heard(&mut bus), ["(0.000000) dev0 707#00"]);
    assert!(bus.devices()[0].shaft(bus.now()).is_none());
    assert_eq!(
        bus.with(0, |device, now| device.set_rpm(1.0, now)),
        Some(false)
    );
    assert!(VirtualDevice::from_eds("nothing", EdsOptions::default()).is_err());
}

#[test]
fn no_frame_panics_anything() {
    let strings = VirtualDevice::from_eds(STRINGS, EdsOptions::default());
    let mut bus = bench(vec![gxmm(1), strings.expect("a device")]);
    let mut decoder = Decoder::default();
    let mut state = 0x2545_F491_4F6C_DD1Du64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let ids = [
        0, 0x80, 0x601, 0x607, 0x581, 0x587, 0x207, 0x701, 0x7E5, 0x181, 0x123,
    ];
    for round in 0..10_000u64 {
        let bits = random();
        let id = ids[(bits % 11) as usize];
        let mut data = random().to_le_bytes();
        if bits & 0x700 != 0 {
            // Usually a frame with a meaning: a real command and a real object.
            data[0] = [0x40, 0x2F, 0x23, 0x60, 0xA4, 0xC6, 0x01, 0x05][(bits >> 11) as usize % 8];
            data[1..4].copy_from_slice(
                [[0, 0x10, 0], [1, 0x20, 0], [0, 0x1A, 1], [2, 0x20, 0]][(bits >> 14) as usize % 4]
                    .as_slice(),
            );
        }
        let frame = Frame::with_dlc(
            od_runtime::CanId::standard(id),
            data,
            (bits >> 20) as u8 % 9,
        );
        let words = decoder.explain(bus.devices(), &frame);
        assert!(!words.text.is_empty());
        bus.receive(&frame);
        while let Some(sent) = bus.poll() {
            decoder.explain(bus.devices(), &sent.frame);
        }
        bus.advance(Instant::from_micros(round * 500));
    }
}

#[test]
fn the_last_256_events_are_kept() {
    let mut device = gxmm(1);
    let now = Instant::ZERO;
    device.power_on(now);
    while device.poll_event().is_some() {}
    for _ in 0..200 {
        for command in [1, 0x80] {
            device.handle_frame(now, &Frame::standard(0, &[command, 1]));
        }
        while device.poll_transmit(now).is_some() {}
    }
    device.handle_frame(now, &Frame::standard(0, &[2, 1]));
    let events: Vec<_> = std::iter::from_fn(|| device.poll_event()).collect();
    assert_eq!(events.len(), 256);
    let last = events.last().expect("256 events");
    assert_eq!(*last, od_runtime::Event::State(State::Stopped));
    let first = events.first().expect("256 events");
    assert_eq!(*first, od_runtime::Event::State(State::PreOperational));
}
