//! A device with node ID 1, switches at 0 and an empty EEPROM, used by frames.

use od_devices::find;
use od_sim::shaft::{self, Shaft};
use odkit::DeviceKind;
use odkit::encoder::Encoder;
use odkit::storage::{Memory, image};
use odkit::{CanId, Frame, Instant, Node, NodeId};

/// The encoder of a device at angle 0.
pub(crate) fn encoder(kind: &DeviceKind) -> Encoder<Shaft> {
    shaft::encoder(kind.encoder().unwrap(), kind.dictionary)
}

/// A device on a bench of its own.
pub(crate) struct Bench {
    pub(crate) node: Node<DeviceKind, Encoder<Shaft>, Memory<Vec<u8>>>,
    pub(crate) now: Instant,
    /// Node ID of the last boot-up message.
    pub(crate) booted: u32,
}

impl Bench {
    /// The device of this name, just switched on.
    pub(crate) fn new(name: &str) -> Self {
        let kind = *find(name).unwrap();
        let storage = Memory::new(vec![0xFF; image::capacity_needed(&kind.dictionary)]);
        let mut bench = Self {
            node: Node::new(kind, NodeId::ONE, encoder(&kind), storage),
            now: Instant::ZERO,
            booted: 0,
        };
        bench.power_on();
        bench
    }

    /// All frames that the device sends now, in order.
    pub(crate) fn sent(&mut self) -> Vec<Frame> {
        let sent = || self.node.poll_transmit(self.now);
        let frames: Vec<Frame> = std::iter::from_fn(sent).collect();
        let boot = |frame: &&Frame| frame.id().raw() & 0x780 == 0x700;
        if let Some(boot) = frames.iter().find(boot) {
            self.booted = boot.id().raw() - 0x700;
        }
        frames
    }

    fn power_on(&mut self) {
        self.node.storage.restore_power();
        self.node.power_on(self.now);
        self.sent();
    }

    /// Moves the shaft to where the sensor value becomes `raw`.
    pub(crate) fn set_raw(&mut self, raw: u64) {
        let encoder = &mut self.node.application;
        encoder.shaft.set_raw(self.now, encoder.sensor(), raw);
    }

    pub(crate) fn power_cycle(&mut self) {
        self.node.application.power_off(self.now);
        self.node.power_off();
        self.now = self.now.plus_millis(100);
        self.power_on();
    }

    pub(crate) fn send(&mut self, id: u16, data: &[u8]) -> Vec<Frame> {
        let frame = Frame::new(CanId::standard(id), data).unwrap();
        self.node.handle_frame(self.now, &frame);
        self.sent()
    }

    /// An expedited download; returns the abort code, if any.
    pub(crate) fn write(&mut self, index: u16, sub: u8, value: u32) -> Result<(), u32> {
        let [low, high] = index.to_le_bytes();
        let [a, b, c, d] = value.to_le_bytes();
        let id = 0x600 + u16::from(self.node.node_id().raw());
        let answers = self.send(id, &[0x22, low, high, sub, a, b, c, d]);
        match answers[0].data() {
            [0x60, ..] => Ok(()),
            [0x80, _, _, _, code @ ..] => Err(u32::from_le_bytes(code.try_into().unwrap())),
            other => panic!("{other:02X?}"),
        }
    }

    pub(crate) fn read(&mut self, index: u16, sub: u8) -> u32 {
        let [low, high] = index.to_le_bytes();
        let id = 0x600 + u16::from(self.node.node_id().raw());
        let answers = self.send(id, &[0x40, low, high, sub]);
        let [0x43 | 0x4B | 0x4F, _, _, _, value @ ..] = answers[0].data() else {
            panic!("{answers:?}");
        };
        u32::from_le_bytes(value.try_into().unwrap())
    }
}
