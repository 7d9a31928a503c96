//! The I/O module: frames in, frames out.

use std::iter;

use od_devices::find;
use od_devices::io::{Io, io};
use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use odkit::storage::NoStorage;
use odkit::{Address, BusEvent, CanId, Frame, Instant, Node, NodeId};

struct Bench {
    node: io::Node<Io>,
    now: Instant,
}

impl Bench {
    /// A module in Operational, whose first PDOs were sent.
    fn new() -> Self {
        let mut bench = Self {
            node: Node::new(io::Device, NodeId::ONE, Io::new(), NoStorage),
            now: Instant::ZERO,
        };
        bench.node.power_on(bench.now);
        assert_eq!(bench.sent(), ["701#00"]);
        assert_eq!(bench.send("000#0100"), ["181#0000", "281#0000000000000000"]);
        bench
    }

    fn sent(&mut self) -> Vec<String> {
        let frames = iter::from_fn(|| self.node.poll_transmit(self.now));
        frames.map(|frame| frame.to_string()).collect()
    }

    fn send(&mut self, text: &str) -> Vec<String> {
        let (id, data) = text.split_once('#').expect("a frame");
        let byte = |at| u8::from_str_radix(&data[at..at + 2], 16).expect("hex");
        let data: Vec<u8> = (0..data.len()).step_by(2).map(byte).collect();
        let id = CanId::standard(u16::from_str_radix(id, 16).expect("hex"));
        let frame = Frame::new(id, &data).expect("at most eight bytes");
        self.node.handle_frame(self.now, &frame);
        self.sent()
    }

    /// Writes an object by SDO.
    #[track_caller]
    fn write(&mut self, index: u16, sub: u8, bytes: &[u8]) {
        let command = 0x23 | (4 - bytes.len() as u8) << 2;
        let mut data = [0; 8];
        data[0] = command;
        data[1..3].copy_from_slice(&index.to_le_bytes());
        data[3] = sub;
        data[4..4 + bytes.len()].copy_from_slice(bytes);
        let hex: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
        let response = self.send(&format!("601#{hex}"));
        assert!(response[0].starts_with("581#60"), "{response:?}");
    }

    /// Sets the terminals; returns the frames of the module.
    fn terminals(&mut self, act: impl FnOnce(&mut Io)) -> Vec<String> {
        self.node.change(self.now, |io, _| act(io));
        self.sent()
    }

    fn inputs(&mut self, inputs: u16) -> Vec<String> {
        self.terminals(|io| io.inputs = inputs)
    }

    fn outputs(&self) -> u16 {
        self.node.application.outputs()
    }

    fn wait(&mut self, millis: u64) -> Vec<String> {
        let end = self.now.plus_millis(millis);
        let mut sent = Vec::new();
        while let Some(at) = self.node.poll_timeout().filter(|at| *at <= end) {
            self.now = at;
            self.node.handle_timeout(at);
            sent.extend(self.sent());
        }
        self.now = end;
        sent
    }
}

#[test]
fn a_changed_input_is_sent() {
    let mut bench = Bench::new();
    assert_eq!(bench.inputs(0x0204), ["181#0402"]);
    assert_eq!(bench.inputs(0x0204), [""; 0]);
    bench.write(0x6002, 1, &[0xFF]);
    assert_eq!(bench.sent(), [""; 0]);
    assert_eq!(bench.inputs(0x0200), ["181#FF02"]);
}

#[test]
fn masks_select_the_edges_that_are_sent() {
    let mut bench = Bench::new();
    // Any change of bit 0, rising edges of bit 1, falling ones of bit 2.
    bench.write(0x6006, 1, &[1]);
    bench.write(0x6007, 1, &[2]);
    bench.write(0x6008, 1, &[4]);
    assert_eq!(bench.inputs(0b1000), [""; 0]);
    assert_eq!(bench.inputs(0b1001), ["181#0900"]);
    assert_eq!(bench.inputs(0b1000), ["181#0800"]);
    assert_eq!(bench.inputs(0b1100), [""; 0]);
    assert_eq!(bench.inputs(0b1110), ["181#0E00"]);
    assert_eq!(bench.inputs(0b1100), [""; 0]);
    assert_eq!(bench.inputs(0b1000), ["181#0800"]);
    bench.write(0x6005, 0, &[0]);
    assert_eq!(bench.inputs(0b0001), [""; 0]);
}

#[test]
fn a_filter_suppresses_short_pulses() {
    let mut bench = Bench::new();
    bench.write(0x6003, 1, &[1]);
    bench.write(0x2000, 0, &[20, 0]);
    assert_eq!(bench.inputs(1), [""; 0]);
    assert_eq!(bench.wait(19), [""; 0]);
    assert_eq!(bench.inputs(0), [""; 0]);
    assert_eq!(bench.wait(100), [""; 0]);
    // Bit 1 has no filter.
    assert_eq!(bench.inputs(3), ["181#0200"]);
    assert_eq!(bench.wait(19), [""; 0]);
    assert_eq!(bench.wait(1), ["181#0300"]);
}

#[test]
fn outputs_follow_the_rpdo_the_filter_mask_and_the_polarity() {
    let mut bench = Bench::new();
    bench.send("201#A501");
    assert_eq!(bench.outputs(), 0x01A5);
    bench.write(0x6208, 1, &[0x0F]);
    bench.send("201#5A01");
    assert_eq!(bench.outputs(), 0x01AA);
    bench.write(0x6202, 2, &[0x80]);
    assert_eq!(bench.outputs(), 0x81AA);
    bench.send("301#FF7F0080");
    let terminals = bench.node.application.analogue_outputs();
    assert_eq!(terminals, [0x7FFF, -0x8000]);
}

#[test]
fn outputs_take_their_error_values_while_the_master_is_lost() {
    let mut bench = Bench::new();
    bench.write(0x6206, 1, &[0x0F]);
    bench.write(0x6207, 1, &[0x05]);
    bench.write(0x6443, 2, &[0]);
    bench.write(0x6444, 1, &[0x00, 0x00, 0x10, 0x00]);
    bench.send("201#FF00");
    bench.send("301#01000200");
    bench.send("000#0200");
    // High outputs have the default mode, low ones have 5; analogue output 1 is limited.
    assert_eq!(bench.outputs(), 0x00F5);
    assert_eq!(bench.node.application.analogue_outputs(), [0x7FFF, 2]);
    bench.send("000#0100");
    assert_eq!(bench.outputs(), 0x00FF);
    // A failed heartbeat, and bus-off.
    bench.write(0x1016, 1, &[0x64, 0, 0x7F, 0]);
    bench.send("77F#05");
    let sent = bench.wait(150);
    assert!(
        sent.iter().any(|one| one.starts_with("081#3081")),
        "{sent:?}"
    );
    assert_eq!(bench.outputs(), 0x00F5);
    bench.send("000#0100");
    assert_eq!(bench.outputs(), 0x00FF);
    bench.node.handle_bus(bench.now, BusEvent::Off);
    assert_eq!(bench.outputs(), 0x00F5);
}

#[test]
fn limits_and_deltas_decide_when_an_analogue_input_is_sent() {
    let mut bench = Bench::new();
    let ain = |bench: &mut Bench, value| bench.terminals(|io| io.analogue_inputs[0] = value);
    assert_eq!(ain(&mut bench, 100), [""; 0], "6423h is 0");
    assert_eq!(ain(&mut bench, 0), [""; 0]);
    bench.write(0x6423, 0, &[1]);
    bench.write(0x6426, 1, &[50, 0, 0, 0]);
    assert_eq!(ain(&mut bench, 49), [""; 0]);
    assert_eq!(ain(&mut bench, 50), ["281#3200000000000000"]);
    assert_eq!(ain(&mut bench, 1), [""; 0]);
    assert_eq!(ain(&mut bench, 0), ["281#0000000000000000"]);
    // Only values above 1000, at each change.
    bench.write(0x6421, 1, &[1]);
    bench.write(0x6424, 1, &[0xE8, 3, 0, 0]);
    assert_eq!(ain(&mut bench, 999), [""; 0]);
    assert_eq!(ain(&mut bench, 1000), ["281#E803000000000000"]);
    assert_eq!(ain(&mut bench, 1001), ["281#E903000000000000"]);
    assert_eq!(ain(&mut bench, 5), [""; 0]);
    // Increases by 10.
    bench.write(0x6421, 1, &[0x10]);
    bench.write(0x6428, 1, &[10, 0, 0, 0]);
    assert_eq!(ain(&mut bench, -300), [""; 0]);
    assert_eq!(ain(&mut bench, 1012), ["281#F403000000000000"]);
    // The sources are shown once.
    assert_eq!(bench.send("601#4022640100000000"), ["581#4322640101000000"]);
    assert_eq!(bench.send("601#4022640100000000"), ["581#4322640100000000"]);
}

#[test]
fn a_short_circuit_is_an_emcy() {
    let mut bench = Bench::new();
    let shorted = bench.terminals(|io| io.is_shorted = true);
    assert_eq!(shorted, ["081#2023030000000000"]);
    let ended = bench.terminals(|io| io.is_shorted = false);
    assert_eq!(ended, ["081#0000000000000000"]);
}

/// Two modules on a bench: an output of one sets an input of the other.
#[test]
fn wires_join_outputs_and_inputs() {
    let kind = find("io").expect("a device");
    let mut bus = Bus::new();
    for id in [1, 2] {
        let device = VirtualDevice::new(kind, NodeId::new(id).expect("a node ID"));
        let number = bus.add(device);
        bus.start(number);
    }
    bus.connect((0, "out3"), (1, "in16")).expect("both exist");
    bus.connect((1, "out1"), (0, "in1")).expect("both exist");
    bus.connect((0, "aout2"), (0, "ain4")).expect("both exist");
    for (from, to, why) in [
        ("out17", "in1", "no connection `out17`"),
        ("out1", "out2", "`out2` is not an input"),
    ] {
        let refused = bus.connect((0, from), (1, to)).expect_err("it is refused");
        assert!(refused.to_string().contains(why), "{refused}");
    }
    bus.receive(&Frame::standard(0, &[1, 0]));
    bus.receive(&Frame::standard(0x201, &[4, 0]));
    bus.receive(&Frame::standard(0x301, &[0, 0, 0x34, 0x12]));
    let read = |bus: &mut Bus, device, index, sub| {
        let address = Address::new(index, sub);
        bus.with(device, |device, now| device.read(address, now))
            .expect("a device")
    };
    assert_eq!(read(&mut bus, 1, 0x6000, 2), [0x80]);
    assert_eq!(read(&mut bus, 0, 0x6401, 4), [0x34, 0x12]);
    bus.set_power(0, false);
    assert_eq!(read(&mut bus, 1, 0x6000, 2), [0]);
}

/// The same as the script `analogue` of the module.
#[test]
fn each_channel_has_its_own_limits() {
    let mut bench = Bench::new();
    let ain = |bench: &mut Bench, value| bench.terminals(|io| io.analogue_inputs[1] = value);
    bench.write(0x6426, 2, &[100, 0, 0, 0]);
    bench.write(0x6423, 0, &[1]);
    assert_eq!(ain(&mut bench, 99), [""; 0]);
    assert_eq!(ain(&mut bench, 100), ["281#0000640000000000"]);
}
