//! odkit: a node with tables made at run time, as `odkit sim` makes them from an EDS file.

use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Tables, Value};
use od_model::{Access, DataType, Dictionary, ObjectCode};
use od_runtime::encoder::Encoder;
use od_runtime::rooms::{LoadedRooms, LoadedValues};
use od_runtime::storage::NoStorage;
use od_runtime::{
    Application, CanId, Device, Frame, Instant, NoApplication, Node, NodeId, Profile, Services,
};
use od_sim::shaft::Shaft;

use crate::contender::{Pdo, Subject, Upload};
use crate::discipline::Simulated;
use crate::objects;

/// Tables that are known at run time, with every service.
#[derive(Clone, Copy, Debug)]
struct Loaded {
    dictionary: Dictionary<'static>,
    profile: &'static Profile,
}

impl Services for Loaded {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

impl Device for Loaded {
    type Values = LoadedValues;
    type Rooms = LoadedRooms;

    fn dictionary(&self) -> Dictionary<'_> {
        self.dictionary
    }

    fn profile(&self) -> &Profile {
        self.profile
    }
}

/// A node, and the time.
#[derive(Debug)]
pub struct Odkit<A = NoApplication> {
    node: Node<Loaded, A>,
    now: Instant,
}

/// A gxmm on its shaft.
pub type Turning = Odkit<Encoder<Shaft>>;

impl Odkit {
    /// A started node with `size` application objects.
    pub fn new(size: usize) -> Self {
        let mut description = communication(objects::mapped(size));
        for object in objects::objects(size) {
            let index = object.index;
            if object.is_record {
                let count = Value::Unsigned(objects::MEMBERS.into());
                add(&mut description, (index, 0), DataType::Unsigned8, count);
            }
            for sub in object.subs() {
                let value = Value::Unsigned(objects::value(index, sub).into());
                add(&mut description, (index, sub), DataType::Unsigned32, value);
            }
        }
        let tables = Box::leak(Box::new(Tables::new(&description)));
        let mut odkit = Self::start(tables.dictionary(), NoApplication, &Profile::CIA301);
        odkit.tell(0x000, &[0x01, objects::NODE_ID]);
        odkit
    }
}

impl Turning {
    /// A gxmm in Operational that has turned at 60 revolutions per minute for 250 ms, with its
    /// position in a TPDO on each SYNC. Time stops from now on.
    pub fn turning() -> Self {
        let device = od_devices::find("gxmm").expect("one of the devices");
        let mut encoder =
            od_sim::shaft::encoder(device.encoder().expect("an encoder"), device.dictionary);
        encoder.shaft.set_milli_rpm(Instant::ZERO, 60_000);
        let mut odkit = Self::start(device.dictionary, encoder, device.profile);
        let node = objects::NODE_ID;
        odkit.write(0x1800, 1, &[0x80 + node, 0x02, 0x00, 0x80]);
        odkit.write(0x1801, 1, &[0x80 + node, 0x01, 0x00, 0x80]);
        odkit.write(0x1801, 2, &[1]);
        odkit.write(0x1801, 1, &[0x80 + node, 0x01, 0x00, 0x00]);
        odkit.tell(0x000, &[0x01, node]);
        odkit.now = Instant::from_millis(250);
        odkit
    }
}

impl<A: Application> Odkit<A> {
    fn start(dictionary: Dictionary<'static>, application: A, profile: &'static Profile) -> Self {
        let device = Loaded {
            dictionary,
            profile,
        };
        let node_id = NodeId::new(objects::NODE_ID).expect("a node-ID");
        let (mut node, now) = (
            Node::new(device, node_id, application, NoStorage),
            Instant::ZERO,
        );
        node.power_on(now);
        node.boot_at_once(now);
        while node.poll_transmit(now).is_some() {}
        Self { node, now }
    }

    /// Writes an object by SDO.
    fn write(&mut self, index: u16, sub: u8, value: &[u8]) {
        let [low, high] = index.to_le_bytes();
        let unused = 4 - value.len() as u8;
        let mut request = [0x23 | unused << 2, low, high, sub, 0, 0, 0, 0];
        request[4..4 + value.len()].copy_from_slice(value);
        let answer = self.upload(&request);
        assert_eq!(answer[0], 0x60, "{index:04X}h:{sub:02X}: {answer:02X?}");
    }

    /// Sends a frame and ignores the response.
    fn tell(&mut self, id: u16, data: &[u8]) {
        let frame = Frame::new(CanId::standard(id), data).expect("8 bytes at most");
        self.node.handle_frame(self.now, &frame);
        while self.node.poll_transmit(self.now).is_some() {}
    }

    /// Sends a frame and returns the response as the host reads it; no frame follows,
    /// and no time passes.
    #[inline(always)]
    fn exchange<R>(&mut self, frame: &Frame, read: impl FnOnce(&Frame) -> R) -> R {
        let Self { node, now } = self;
        node.handle_frame(*now, frame);
        let answer = node.poll_transmit(*now).expect("an answer");
        let answer = read(&answer);
        let next = node.poll_transmit(*now);
        assert!(next.is_none(), "one answer");
        answer
    }
}

impl<A: Application> Upload for Odkit<A> {
    #[inline]
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8] {
        let id = CanId::standard(0x600 + u16::from(objects::NODE_ID));
        self.exchange(&Frame::full(id, *request), |answer| *answer.bytes())
    }
}

impl<A: Application> Pdo for Odkit<A> {
    #[inline]
    fn sync(&mut self) -> (u16, [u8; 4]) {
        self.exchange(&Frame::standard(0x080, &[]), |tpdo| {
            let id = tpdo.id().as_standard().expect("11 bits");
            (id, tpdo.data().try_into().expect("four bytes"))
        })
    }
}

/// 1000h, 1001h, 1005h, 1017h, 1018h, and a TPDO on every SYNC that maps the U32 at `mapped`.
fn communication(mapped: u16) -> Description {
    use DataType::{Unsigned8, Unsigned16, Unsigned32};
    let node = u64::from(objects::NODE_ID);
    let mapping = u64::from(mapped) << 16 | 32;
    let mut description = Description::default();
    for (address, data_type, value) in [
        ((0x1000, 0), Unsigned32, 0),
        ((0x1001, 0), Unsigned8, 0),
        ((0x1005, 0), Unsigned32, 0x80),
        ((0x1017, 0), Unsigned16, 0),
        ((0x1018, 0), Unsigned8, 4),
        ((0x1018, 1), Unsigned32, 1),
        ((0x1018, 2), Unsigned32, 2),
        ((0x1018, 3), Unsigned32, 3),
        ((0x1018, 4), Unsigned32, 4),
        ((0x1800, 0), Unsigned8, 5),
        ((0x1800, 1), Unsigned32, 0x180 + node),
        ((0x1800, 2), Unsigned8, 1),
        ((0x1800, 3), Unsigned16, 0),
        ((0x1800, 5), Unsigned16, 0),
        ((0x1A00, 0), Unsigned8, 1),
        ((0x1A00, 1), Unsigned32, mapping),
    ] {
        add(&mut description, address, data_type, Value::Unsigned(value));
    }
    description
}

/// A value that a master may read, write and map.
fn add(
    description: &mut Description,
    (index, sub): (u16, u8),
    data_type: DataType,
    default: Value,
) {
    let mut entry = EntryDescription::new(format!("{index:04X}h:{sub:02X}"), data_type);
    entry.access = Spanned::from(Access::Rw);
    entry.mappable = Spanned::from(true);
    entry.default = Some(Spanned::from(default));
    let object = description
        .objects
        .entry(index)
        .or_insert_with(|| ObjectDescription::var(entry.clone()));
    if sub > 0 {
        object.code = Spanned::from(ObjectCode::Record);
    }
    object.entries.insert(sub, entry);
}

/// One operation is one second of virtual time: a PDO every millisecond.
#[allow(missing_debug_implementations)] // nobody looks into it
pub struct Seconds(Turning);

impl Seconds {
    /// A device at 60 rpm in Operational whose TPDO 1 is cyclic with 1 ms and
    /// whose TPDO 2 is off.
    pub fn new(Simulated { device, is_moving }: Simulated) -> Self {
        let device = od_devices::find(device).expect("one of the devices");
        let mut encoder =
            od_sim::shaft::encoder(device.encoder().expect("an encoder"), device.dictionary);
        encoder.shaft.set_milli_rpm(Instant::ZERO, 60_000);
        let mut odkit = Odkit::start(device.dictionary, encoder, device.profile);
        let node = objects::NODE_ID;
        odkit.write(0x1800, 1, &[0x80 + node, 0x01, 0x00, 0x80]);
        odkit.write(0x1800, 2, &[254]);
        odkit.write(0x1800, 5, &[1, 0]);
        if is_moving {
            odkit.write(0x1A00, 0, &[0]);
            // 64 bits are enough if speed and acceleration have 16; otherwise only for these two.
            let mapped = [(0x6004u16, 0u8), (0x6030, 1), (0x6040, 1)].map(|(index, sub)| {
                let entry = device.dictionary.entry(index, sub);
                let bits = entry.and_then(|entry| entry.data_type.bits());
                let bits = bits.expect("an encoder's number");
                u32::from(index) << 16 | u32::from(sub) << 8 | u32::from(bits)
            });
            let bits: u32 = mapped.iter().map(|mapped| mapped & 0xFF).sum();
            let mapped = if bits > 64 { &mapped[1..] } else { &mapped[..] };
            for (sub, mapped) in (1u8..).zip(mapped) {
                odkit.write(0x1A00, sub, &mapped.to_le_bytes());
            }
            odkit.write(0x1A00, 0, &[mapped.len() as u8]);
        }
        odkit.write(0x1800, 1, &[0x80 + node, 0x01, 0x00, 0x00]);
        odkit.write(0x1801, 1, &[0x80 + node, 0x02, 0x00, 0x80]);
        odkit.tell(0x000, &[0x01, node]);
        Self(odkit)
    }

    /// Work of a host for a second: sleep until the deadline, pass the time, send the frames.
    /// Returns the number of frames.
    fn second(&mut self) -> u32 {
        let Odkit { node, now } = &mut self.0;
        let end = now.plus_millis(1_000);
        let mut frames = 0;
        while let Some(at) = node.poll_timeout().filter(|at| *at <= end) {
            *now = at.max(*now);
            node.handle_timeout(*now);
            while let Some(frame) = node.poll_transmit(*now) {
                std::hint::black_box(frame);
                frames += 1;
            }
        }
        *now = end;
        frames
    }
}

impl Subject for Seconds {
    fn verify(&mut self) {
        assert_eq!(self.second(), 1_000, "a PDO every millisecond");
    }

    fn run(&mut self, count: u64) {
        for _ in 0..count {
            self.second();
        }
    }
}
