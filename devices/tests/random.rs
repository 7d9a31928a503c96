//! Random frames, CAN controller events and power cuts: no device panics, answers frames for
//! others, has a value outside its limits, or stops its clock.
//!
//! `OD_RANDOM_FRAMES=10000000` sets the total number of frames.

use od_devices::encoders;
use od_sim::shaft::{self, Shaft};
use odkit::DeviceKind;
use odkit::Kind;
use odkit::encoder::Encoder;
use odkit::nmt::State;
use odkit::storage::{Memory, image};
use odkit::{BusEvent, CanId, Frame, Instant, Node, NodeId};

/// xorshift64*: the same frames in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 16
    }

    fn below(&mut self, end: usize) -> usize {
        self.next() as usize % end
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    fn one_in(&mut self, count: u64) -> bool {
        self.next().is_multiple_of(count)
    }
}

struct Bench {
    kind: &'static DeviceKind,
    node: Node<DeviceKind, Encoder<Shaft>, Memory<Vec<u8>>>,
    now: Instant,
    /// SDO requests to this node without a response yet.
    open: usize,
}

impl Bench {
    fn new(kind: &'static DeviceKind) -> Self {
        let storage = Memory::new(vec![0xFF; image::capacity_needed(&kind.dictionary)]);
        let mut bench = Self {
            kind,
            node: Node::new(
                *kind,
                NodeId::ONE,
                shaft::encoder(kind.encoder().unwrap(), kind.dictionary),
                storage,
            ),
            now: Instant::ZERO,
            open: 0,
        };
        bench.power_on();
        bench
    }

    fn power_on(&mut self) {
        self.node.storage.restore_power();
        self.open = 0;
        self.node.power_on(self.now);
        self.drain();
    }

    /// Checks that each sent frame is allowed.
    fn drain(&mut self) {
        let node_id = u32::from(self.node.node_id().raw());
        while let Some(frame) = self.node.poll_transmit(self.now) {
            assert!(!self.node.is_bus_off(), "{frame}");
            if frame.id() == CanId::standard(0x580 + node_id as u16) {
                assert!(self.open > 0, "{frame}: nobody asked");
                self.open -= 1;
                assert_eq!(frame.dlc(), 8, "{frame}");
            }
        }
        assert!(self.node.poll_timeout().is_none_or(|at| at >= self.now));
    }

    fn send(&mut self, frame: &Frame) {
        let request = CanId::standard(0x600 + u16::from(self.node.node_id().raw()));
        let heard = !matches!(self.node.state(), State::Stopped | State::Initialising);
        if frame.id() == request && !frame.is_remote() && heard && !self.node.is_bus_off() {
            self.open += 1;
        }
        self.node.handle_frame(self.now, frame);
        self.drain();
    }

    fn wait(&mut self, millis: u64) {
        let end = self.now.plus_millis(millis);
        let mut turns = 0;
        while let Some(at) = self.node.poll_timeout().filter(|at| *at <= end) {
            self.now = self.now.max(at);
            self.node.handle_timeout(self.now);
            self.drain();
            turns += 1;
            // Two PDOs, a heartbeat and others, each at most once a millisecond.
            assert!(turns <= 8 * (millis + 1), "time stops at {:?}", self.now);
        }
        self.now = end;
    }

    fn check_limits(&mut self) {
        let (node_id, name) = (self.node.node_id(), self.kind.name);
        self.node.look(|_, store| {
            let entries = store.dictionary().entries();
            for entry in entries.filter(|entry| entry.access.writable()) {
                let Some(bits) = entry.data_type.bits().filter(|bits| *bits <= 64) else {
                    continue;
                };
                let value = match entry.data_type.kind() {
                    Kind::Unsigned => i128::from(store.number(&entry)),
                    Kind::Signed => {
                        let unused = 64 - u32::from(bits);
                        i128::from((store.number(&entry) << unused) as i64 >> unused)
                    }
                    _ => continue,
                };
                let low = entry.low.integer(node_id.raw()).unwrap_or(i128::MIN);
                let high = entry.high.integer(node_id.raw()).unwrap_or(i128::MAX);
                let is_within = (low..=high).contains(&value);
                assert!(is_within, "{name}: {} is {value}", entry.address);
            }
        });
    }

    /// A frame that is valid more often than a random one.
    fn frame(&mut self, random: &mut Random) -> Frame {
        let node_id = u16::from(self.node.node_id().raw());
        let sdo = 0x600 + node_id;
        let error_control = 0x700 + node_id;
        let id = random.pick(&[
            0x000, 0x080, 0x181, sdo, sdo, sdo, sdo, sdo, sdo, 0x67F, 0x705, 0x7E5,
        ]);
        if random.one_in(30) {
            let id = random.pick(&[0x181, 0x281, error_control, sdo, 0x7E5]);
            return Frame::remote(CanId::standard(id), random.below(9) as u8).unwrap();
        }
        let mut bytes: [u8; 8] = std::array::from_fn(|_| random.next() as u8);
        if id == 0 {
            bytes[0] = random.pick(&[0x01, 0x01, 0x01, 0x80, 0x80, 0x02, 0x81, 0x82, 0x55]);
            bytes[1] = random.pick(&[0, node_id as u8, 126]);
            return Frame::with_dlc(CanId::standard(0), bytes, 2);
        }
        if id == 0x7E5 {
            bytes[0] = random.pick(&[0x04, 0x11, 0x13, 0x15, 0x17, 0x4C, 0x51, 0x5A, 0x5E, 0x40]);
            bytes[1] = random.pick(&[0, 1, 1, 2, 5, 127, 255]);
            bytes[2] = random.below(10) as u8;
        }
        if id == sdo && !random.one_in(8) {
            bytes[0] = random.pick(&[
                0x22, 0x22, 0x22, 0x23, 0x2B, 0x2F, 0x21, 0x40, 0x40, 0x60, 0x70, 0x00, 0x80, 0xA4,
                0xC6, bytes[0],
            ]);
            let entries = self.kind.dictionary.entries();
            let entry = entries.get(random.below(entries.len()));
            let address = entry.expect("a value").address;
            bytes[1..3].copy_from_slice(&address.index.to_le_bytes());
            bytes[3] = address.sub;
            if matches!(address.index, 0x1010 | 0x1011) {
                bytes[0] = 0x22;
                bytes[4..].copy_from_slice(&random.pick(&[*b"save", *b"load", [0; 4]]));
            } else if random.one_in(2) {
                bytes[4] = random.pick(&[0, 1, 2, 4, 8, 50, bytes[4]]);
                bytes[5..].copy_from_slice(&random.pick(&[[0; 3], [1, 0, 0], [0, 0, 0x80]]));
            }
        }
        let dlc = if random.one_in(8) { random.below(9) } else { 8 };
        Frame::with_dlc(CanId::standard(id), bytes, dlc as u8)
    }

    fn turn(&mut self, random: &mut Random) {
        if random.one_in(500) {
            let event = random.pick(&[
                BusEvent::Warning,
                BusEvent::Passive,
                BusEvent::Off,
                BusEvent::Overrun,
                BusEvent::Active,
            ]);
            self.node.handle_bus(self.now, event);
            self.drain();
        }
        if self.node.is_bus_off() && random.one_in(20) {
            self.node.handle_bus(self.now, BusEvent::Active);
            self.drain();
        }
        if random.one_in(2_000) || self.node.is_bus_off() && random.one_in(200) {
            self.node.application.power_off(self.now);
            self.node.power_off();
            self.now = self.now.plus_millis(1);
            self.power_on();
        }
        if random.one_in(3_000) {
            self.node.storage.cut_after(random.below(900));
        }
        let frame = self.frame(random);
        self.send(&frame);
        if random.one_in(8) {
            let millis = random.pick(&[1, 5, 20, 100, 200]);
            self.wait(millis);
        }
    }
}

#[test]
fn any_frame_at_any_time_on_every_device() {
    let frames = std::env::var("OD_RANDOM_FRAMES").ok();
    let frames: u64 = frames.and_then(|text| text.parse().ok()).unwrap_or(120_000);
    for (seed, kind) in (1..).zip(encoders()) {
        let mut random = Random(0x9E37_79B9_7F4A_7C15 ^ seed);
        let mut bench = Bench::new(kind);
        for step in 0..frames / encoders().count() as u64 {
            bench.turn(&mut random);
            if step.is_multiple_of(64) {
                bench.check_limits();
            }
        }
    }
}
