//! We: a node over tables made at run time, as `odkit sim` makes them of an EDS file.

use od_model::{
    Access, DataType, Description, EntryDescription, ObjectCode, ObjectDescription, Spanned,
    Tables, Value,
};
use od_runtime::storage::Memory;
use od_runtime::{
    Application, CanId, Device, Frame, Instant, NoApplication, Node, NodeId, Profile,
};

use crate::contender::{Pdo, Subject, Upload};
use crate::objects;

/// A node with everything that it needs.
#[allow(missing_debug_implementations)] // nobody looks into it
pub struct Odkit<A = NoApplication> {
    node: Node,
    tables: Tables,
    values: Vec<u8>,
    application: A,
    storage: Memory<Vec<u8>>,
    profile: Profile,
    now: Instant,
}

/// What the node asks of its device, for one input and what it sends.
macro_rules! device {
    ($of:expr) => {
        &mut Device {
            dictionary: $of.tables.dictionary(),
            values: &mut $of.values,
            application: &mut $of.application,
            storage: &mut $of.storage,
            profile: &$of.profile,
        }
    };
}

impl Odkit {
    /// A started node with `size` application objects.
    pub fn new(size: usize) -> Self {
        let mut description = communication(1, 0, objects::mapped(size));
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
        Self::start(&description, NoApplication, Profile::CIA301)
    }
}

impl<A: Application> Odkit<A> {
    fn start(description: &Description, application: A, profile: Profile) -> Self {
        let tables = Tables::new(description);
        let mut odkit = Self {
            node: Node::new(NodeId::new(objects::NODE_ID).expect("a node-ID")),
            values: vec![0; tables.dictionary().store_len()],
            tables,
            application,
            storage: Memory::new(Vec::new()),
            profile,
            now: Instant::ZERO,
        };
        let (device, now) = (device!(odkit), odkit.now);
        let powered = odkit.node.power_on(device, now);
        powered.expect("the values fit");
        let start = Frame::standard(0x000, &[0x01, objects::NODE_ID]);
        odkit.node.handle_frame(device, now, &start);
        while odkit.node.poll_transmit(device, now).is_some() {}
        odkit
    }

    /// A frame in, the node's answer out, and no frame after it; no time passes.
    #[inline]
    fn exchange(&mut self, frame: &Frame) -> Frame {
        let device = device!(self);
        self.node.handle_frame(device, self.now, frame);
        let answer = self.node.poll_transmit(device, self.now);
        let next = self.node.poll_transmit(device, self.now);
        assert!(next.is_none(), "one answer");
        answer.expect("an answer")
    }
}

impl Upload for Odkit {
    #[inline]
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8] {
        let id = CanId::standard(0x600 + u16::from(objects::NODE_ID));
        *self.exchange(&Frame::new(id, request)).bytes()
    }
}

impl Pdo for Odkit {
    #[inline]
    fn sync(&mut self) -> (u16, [u8; 4]) {
        let frame = self.exchange(&Frame::standard(0x080, &[]));
        let id = frame.id().as_standard().expect("11 bits");
        (id, frame.data().try_into().expect("four bytes"))
    }
}

/// 1000h, 1001h, 1005h, 1017h, 1018h, and one TPDO of `kind` that maps the U32 at `mapped`.
fn communication(kind: u64, event_ms: u64, mapped: u16) -> Description {
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
        ((0x1800, 2), Unsigned8, kind),
        ((0x1800, 3), Unsigned16, 0),
        ((0x1800, 5), Unsigned16, event_ms),
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
pub struct Seconds<A>(Odkit<A>);

impl Seconds<NoApplication> {
    /// A started stand-in.
    pub fn new() -> Self {
        let mut description = communication(254, 1, 0x6004);
        add(
            &mut description,
            (0x6004, 0),
            DataType::Unsigned32,
            Value::Unsigned(4711),
        );
        let mut profile = Profile::CIA301;
        profile.pdo.event_on_change = false;
        Self(Odkit::start(&description, NoApplication, profile))
    }
}

impl Default for Seconds<NoApplication> {
    fn default() -> Self {
        Self::new()
    }
}

impl<A: Application> Seconds<A> {
    /// What a host does: sleep until the deadline, tell the time, send what is there.
    /// Answers with the number of frames.
    fn second(&mut self) -> u32 {
        let Self(odkit) = self;
        let end = odkit.now.plus_millis(1_000);
        let mut frames = 0;
        while let Some(at) = odkit.node.poll_timeout().filter(|at| *at <= end) {
            let device = device!(odkit);
            odkit.now = odkit.now.max(at);
            odkit.node.handle_timeout(device, odkit.now);
            while let Some(frame) = odkit.node.poll_transmit(device, odkit.now) {
                std::hint::black_box(frame);
                frames += 1;
            }
        }
        odkit.now = end;
        frames
    }
}

impl<A: Application> Subject for Seconds<A> {
    fn verify(&mut self) {
        assert_eq!(self.second(), 1_000, "a PDO every millisecond");
    }

    fn run(&mut self, count: u64) {
        for _ in 0..count {
            self.second();
        }
    }
}
