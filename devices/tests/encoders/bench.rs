//! A device with node ID 1 and an empty EEPROM, used by frames of eight bytes.

use od_devices::find;
use od_sim::shaft::Shaft;
use odkit::DeviceKind;
use odkit::encoder::{Angle, Encoder, Motion};
use odkit::nmt::State;
use odkit::storage::{Memory, image};
use odkit::{CanId, Event, Frame, Instant, Node, NodeId};

pub(crate) const SAVE: u32 = u32::from_le_bytes(*b"save");
/// MANUALS.md U-05.
pub(crate) const OUT_OF_RANGE: Result<(), u32> = Err(0x0609_0030);
pub(crate) const TOO_GREAT: Result<(), u32> = Err(0x0609_0031);
pub(crate) const TOO_LITTLE: Result<(), u32> = Err(0x0609_0032);
/// C-EN-11.
pub(crate) const INCOMPATIBLE: Result<(), u32> = Err(0x0604_0043);

pub(crate) struct Bench<M: Motion = Shaft> {
    pub(crate) node: Node<DeviceKind, Encoder<M>, Memory<Vec<u8>>>,
    pub(crate) now: Instant,
    /// Frames that were not requested, in order.
    pub(crate) heard: Vec<Frame>,
}

impl Bench {
    /// The device of this name, just switched on at time 0.
    pub(crate) fn new(name: &str) -> Self {
        Self::on(Shaft::default(), name)
    }

    pub(crate) fn rpm(&mut self, milli_rpm: i32) {
        self.change(|encoder, now| encoder.shaft.set_milli_rpm(now, milli_rpm));
    }

    /// Turns the shaft by whole revolutions.
    pub(crate) fn turn(&mut self, revolutions: i64) {
        self.turn_fractions(revolutions << 32);
    }

    /// Turns the shaft by 2⁻³² revolutions.
    pub(crate) fn turn_fractions(&mut self, fractions: i64) {
        let by = Angle::from_fractions(fractions);
        self.node.application.shaft.turn(self.now, by);
    }

    /// Switches the power off for `off_ms`, while the shaft turns by `revolutions`.
    pub(crate) fn power_cycle(&mut self, off_ms: u64, revolutions: i64) {
        self.power_off();
        self.turn(revolutions);
        self.now = self.now.plus_millis(off_ms);
        self.power_on();
    }
}

impl<M: Motion> Bench<M> {
    /// The device of this name on a shaft, just switched on at time 0.
    pub(crate) fn on(shaft: M, name: &str) -> Self {
        let kind = *find(name).unwrap();
        let encoder = Encoder::new(kind.encoder().unwrap(), shaft).with_sensor_of(kind.dictionary);
        let storage = Memory::new(vec![0xFF; image::capacity_needed(&kind.dictionary)]);
        let mut bench = Self {
            node: Node::new(kind, NodeId::ONE, encoder, storage),
            now: Instant::ZERO,
            heard: Vec::new(),
        };
        bench.power_on();
        bench
    }

    fn listen(&mut self) {
        while let Some(frame) = self.node.poll_transmit(self.now) {
            self.heard.push(frame);
        }
    }

    pub(crate) fn power_on(&mut self) {
        self.node.storage.restore_power();
        self.node.power_on(self.now);
        self.node.boot_at_once(self.now);
        self.listen();
    }

    pub(crate) fn power_off(&mut self) {
        // This test is not about a save in the background.
        self.wait(2_000);
        self.node.application.power_off(self.now);
        self.node.power_off();
    }

    /// Lets time pass, and handles all deadlines at their time.
    pub(crate) fn wait(&mut self, ms: u64) {
        let until = self.now.plus_millis(ms);
        while let Some(at) = self.node.poll_timeout().filter(|at| *at <= until) {
            self.now = self.now.max(at);
            self.node.handle_timeout(self.now);
            self.listen();
        }
        self.now = until;
    }

    /// An NMT command to all nodes, and the time of a reset.
    pub(crate) fn nmt(&mut self, command: u8) {
        self.send(0, &[command, 0]);
        self.wait(1000);
    }

    /// Events of the node since the last call.
    pub(crate) fn events(&mut self) -> Vec<Event> {
        std::iter::from_fn(|| self.node.poll_event()).collect()
    }

    pub(crate) fn state(&self) -> State {
        self.node.state()
    }

    /// An input of the application has changed.
    pub(crate) fn change(&mut self, act: impl FnOnce(&mut Encoder<M>, Instant)) {
        act(&mut self.node.application, self.now);
        self.node.handle_change(self.now);
        self.listen();
    }

    pub(crate) fn send(&mut self, id: u16, data: &[u8]) {
        let frame = Frame::new(CanId::standard(id), data).unwrap();
        self.node.handle_frame(self.now, &frame);
        self.listen();
    }

    fn request(&mut self, data: [u8; 8]) -> [u8; 8] {
        let heard = std::mem::take(&mut self.heard);
        self.send(0x601, &data);
        let is_answer = |frame: &Frame| frame.id() == CanId::standard(0x581);
        for _ in 0..1000 {
            // A save is confirmed when it is complete.
            if self.heard.iter().any(is_answer) {
                break;
            }
            self.wait(1);
        }
        let answers = std::mem::replace(&mut self.heard, heard);
        let (answer, others): (Vec<Frame>, Vec<Frame>) = answers
            .into_iter()
            .partition(|frame| frame.id() == CanId::standard(0x581));
        self.heard.extend(others);
        answer[0].data().try_into().unwrap()
    }

    /// An expedited download; returns the abort code, if any.
    pub(crate) fn write(&mut self, index: u16, sub: u8, value: u32) -> Result<(), u32> {
        let [low, high] = index.to_le_bytes();
        let [a, b, c, d] = value.to_le_bytes();
        match self.request([0x22, low, high, sub, a, b, c, d]) {
            [0x60, ..] => Ok(()),
            [0x80, _, _, _, a, b, c, d] => Err(u32::from_le_bytes([a, b, c, d])),
            other => panic!("{other:02X?}"),
        }
    }

    pub(crate) fn read(&mut self, index: u16, sub: u8) -> u32 {
        let [low, high] = index.to_le_bytes();
        match self.request([0x40, low, high, sub, 0, 0, 0, 0]) {
            [0x43 | 0x4B | 0x4F, _, _, _, a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
            other => panic!("{index:X}h:{sub} {other:02X?}"),
        }
    }

    /// An INTEGER16.
    pub(crate) fn read16(&mut self, index: u16, sub: u8) -> i16 {
        self.read(index, sub) as u16 as i16
    }

    pub(crate) fn position(&mut self) -> u32 {
        self.read(0x6004, 0)
    }

    /// The EMCY messages since the last call: code, 1001h, 6503h, 6505h.
    pub(crate) fn emcys(&mut self) -> Vec<(u16, u8, u16, u16)> {
        let heard = std::mem::take(&mut self.heard);
        let emcys = heard
            .iter()
            .filter(|frame| frame.id() == CanId::standard(0x81));
        emcys
            .map(|frame| match *frame.data() {
                [a, b, register, c, d, e, f, 0] => (
                    u16::from_le_bytes([a, b]),
                    register,
                    u16::from_le_bytes([c, d]),
                    u16::from_le_bytes([e, f]),
                ),
                _ => panic!("{frame:?}"),
            })
            .collect()
    }
}
