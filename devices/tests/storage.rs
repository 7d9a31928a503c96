//! Save, restore and power cycles of a whole gxmm (manual 000, objects 1010h and 1011h,
//! chapter 7.2.1).

use od_devices::find;
use od_runtime::encoder::{Encoder, Fault, Switches};
use od_runtime::storage::{Memory, image};
use od_runtime::{CanId, Device, Frame, Instant, Node, NodeId};

/// A gxmm on a bench of its own.
struct Bench {
    values: Vec<u8>,
    storage: Memory<Vec<u8>>,
    encoder: Encoder,
    node: Node,
    now: Instant,
    /// Node ID of the last boot-up message.
    booted: u32,
}

impl Bench {
    fn new() -> Self {
        let kind = find("gxmm").unwrap();
        let mut bench = Self {
            values: vec![0; kind.dictionary.store_len()],
            storage: Memory::new(vec![0xFF; image::capacity_needed(&kind.dictionary)]),
            encoder: kind.new_encoder(),
            node: Node::new(NodeId::ONE),
            now: Instant::ZERO,
            booted: 0,
        };
        bench.power_on();
        bench
    }

    fn with<R>(&mut self, call: impl FnOnce(&mut Node, &mut Device<'_>, Instant) -> R) -> R {
        let kind = find("gxmm").unwrap();
        let mut device = Device {
            dictionary: kind.dictionary,
            values: &mut self.values,
            application: &mut self.encoder,
            storage: &mut self.storage,
            profile: kind.profile,
        };
        call(&mut self.node, &mut device, self.now)
    }

    /// Everything that the device sends now, in its order.
    fn sent(&mut self) -> Vec<Frame> {
        let frames: Vec<Frame> = self.with(|node, device, now| {
            std::iter::from_fn(|| node.poll_transmit(device, now)).collect()
        });
        let boot = |frame: &&Frame| frame.id().raw() & 0x780 == 0x700;
        if let Some(boot) = frames.iter().find(boot) {
            self.booted = boot.id().raw() - 0x700;
        }
        frames
    }

    fn power_on(&mut self) {
        self.storage.restore_power();
        self.with(|node, device, now| node.power_on(device, now).unwrap());
        self.sent();
    }

    fn power_cycle(&mut self) {
        self.encoder.power_off(self.now);
        self.node.power_off();
        self.now = self.now.plus_millis(100);
        self.power_on();
    }

    fn send(&mut self, id: u16, data: &[u8]) -> Vec<Frame> {
        let frame = Frame::new(CanId::standard(id), data);
        self.with(|node, device, now| node.handle_frame(device, now, &frame));
        self.sent()
    }

    /// An expedited download; the abort code if there was one.
    fn write(&mut self, index: u16, sub: u8, value: u32) -> Result<(), u32> {
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

    fn read(&mut self, index: u16, sub: u8) -> u32 {
        let [low, high] = index.to_le_bytes();
        let id = 0x600 + u16::from(self.node.node_id().raw());
        let answers = self.send(id, &[0x40, low, high, sub]);
        let [0x43 | 0x4B | 0x4F, _, _, _, value @ ..] = answers[0].data() else {
            panic!("{answers:?}");
        };
        u32::from_le_bytes(value.try_into().unwrap())
    }
}

const SAVE: u32 = u32::from_le_bytes(*b"save");
const LOAD: u32 = u32::from_le_bytes(*b"load");

#[test]
fn what_is_saved_is_there_after_a_power_cycle() {
    let mut bench = Bench::new();
    bench.encoder.set_raw_position(bench.now, 0x7_9592);
    bench.write(0x6003, 0, 1000).unwrap();
    bench.write(0x6200, 0, 7).unwrap();
    bench.write(0x2300, 3, 0xBEEF).unwrap();
    bench.write(0x1017, 0, 100).unwrap();
    bench.power_cycle();
    assert_eq!(bench.read(0x6004, 0), 0x7_9592, "nothing was saved");
    bench.write(0x6003, 0, 1000).unwrap();
    bench.write(0x6200, 0, 7).unwrap();
    bench.write(0x2300, 3, 0xBEEF).unwrap();
    assert_eq!(bench.write(0x1010, 1, LOAD), Err(0x0800_0020));
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle();
    assert_eq!(bench.read(0x6004, 0), 1000);
    assert_eq!((bench.read(0x6200, 0), bench.read(0x1800, 5)), (7, 7));
    assert_eq!(bench.read(0x2300, 3), 0xBEEF);
    bench.write(0x1011, 1, LOAD).unwrap();
    assert_eq!(bench.read(0x6004, 0), 0x7_9592, "at once");
    bench.power_cycle();
    assert_eq!(bench.read(0x6004, 0), 0x7_9592, "and after a power cycle");
}

#[test]
fn the_node_id_acts_at_the_next_start() {
    let mut bench = Bench::new();
    assert_eq!(bench.booted, 1);
    bench.write(0x2101, 0, 2).unwrap();
    bench.write(0x1010, 4, SAVE).unwrap();
    assert_eq!(bench.read(0x2101, 0), 2, "still answers as node 1");
    bench.power_cycle();
    assert_eq!(bench.booted, 2);
    assert_eq!(bench.read(0x1800, 1), 0x182, "the default follows");
    bench.write(0x1800, 1, 0x181).unwrap();
    bench.write(0x1010, 2, SAVE).unwrap();
    bench.encoder.set_switches(Switches {
        node_id: 42,
        bit_rate: 4,
    });
    bench.power_cycle();
    assert_eq!((bench.booted, bench.encoder.bit_rate()), (42, Some(250)));
    assert_eq!((bench.read(0x2101, 0), bench.read(0x1801, 1)), (2, 0x2AA));
    assert_eq!(bench.read(0x1800, 1), 0x181, "a value of the user's stays");
}

#[test]
fn statistics_survive_a_restore() {
    let mut bench = Bench::new();
    for broken in [true, false] {
        bench.encoder.set_fault(Fault::Position, broken);
        bench.with(|node, device, now| node.handle_change(device, now));
        let emcy = bench.sent();
        let expected: [u8; 8] = match broken {
            true => [0x20, 0x73, 0x81, 1, 0, 0, 0, 0],
            false => [0; 8],
        };
        assert_eq!(emcy, [Frame::new(CanId::standard(0x81), &expected)]);
    }
    bench.write(0x1011, 1, LOAD).unwrap();
    assert_eq!(bench.read(0x2201, 1), 1);
    assert_eq!(bench.read(0x1003, 1), 0x7320);
    bench.write(0x1010, 2, SAVE).unwrap();
    bench.encoder = find("gxmm").unwrap().new_encoder();
    bench.power_cycle();
    assert_eq!(bench.read(0x2201, 1), 1, "from the EEPROM");
}

#[test]
fn a_save_that_power_cuts_leaves_the_set_before() {
    let mut bench = Bench::new();
    bench.write(0x6001, 0, 1000).unwrap();
    bench.write(0x6002, 0, 5000).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    for cut in 0.. {
        bench.write(0x6001, 0, 2000).unwrap();
        bench.write(0x6002, 0, 7000).unwrap();
        bench.storage.cut_after(cut);
        let saved = bench.write(0x1010, 1, SAVE);
        bench.power_cycle();
        let values = (bench.read(0x6001, 0), bench.read(0x6002, 0));
        if saved.is_ok() {
            assert_eq!(values, (2000, 7000));
            break;
        }
        assert_eq!(saved, Err(0x0800_0021));
        assert_eq!(values, (1000, 5000), "cut at {cut}");
    }
}
