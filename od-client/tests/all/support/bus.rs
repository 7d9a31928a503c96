//! A client and nodes of `od-runtime` on one bus, in virtual time.

use od_client::{Client, Event, Frame, Instant, NodeId};
use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Tables, Value};
use od_model::Address;
use od_model::{Access, DataType, ObjectCode};
use od_runtime::storage::Memory;
use od_runtime::{
    AbortCode, AnyDevice, Application, Chunk, Context, Halt, Lent, LssProfile, Node, Profile,
    Store, Stream,
};

use super::pattern_at;

/// Most bytes of the object 2003h.
pub(crate) const ROOM: usize = 8192;

/// One device on the bus.
pub(crate) struct Peer {
    tables: Tables,
    values: Vec<u8>,
    storage: Memory<Vec<u8>>,
    pub(crate) profile: Profile,
    pub(crate) node: Node<AnyDevice, 4, ROOM>,
    pub(crate) application: Stored,
}

/// The node starts with the node ID in 2101h. What goes through 2004h is [`pattern`], of which
/// nobody here has more than a part.
#[derive(Default)]
pub(crate) struct Stored {
    /// Bytes of 2004h.
    pub(crate) len: usize,
    /// Bytes of the largest part.
    pub(crate) largest: usize,
}

impl Application for Stored {
    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        NodeId::new(store.unsigned(0x2101, 0) as u8)
    }

    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        if address.index == 0x2004 {
            Some(self)
        } else {
            None
        }
    }
}

impl Stream for Stored {
    fn begin_download(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        _: Option<u32>,
    ) -> Result<(), Halt> {
        self.len = 0;
        Ok(())
    }

    fn write(&mut self, _: &mut Context<'_, '_>, _: Address, chunk: Chunk<'_>) -> Result<(), Halt> {
        let is_right = |(at, byte): (usize, &u8)| *byte == pattern_at(self.len + at);
        if chunk.at as usize != self.len || !chunk.bytes.iter().enumerate().all(is_right) {
            return Err(AbortCode::ValueRange.into());
        }
        self.len += chunk.bytes.len();
        self.largest = self.largest.max(chunk.bytes.len());
        Ok(())
    }

    fn begin_upload(&mut self, _: &mut Context<'_, '_>, _: Address) -> Result<u32, Halt> {
        Ok(self.len as u32)
    }

    fn read(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        self.largest = self.largest.max(to.len());
        for (at, byte) in (at as usize..).zip(to) {
            *byte = pattern_at(at);
        }
        Ok(())
    }
}

const RATES: [Option<u8>; 9] = [
    Some(8),
    Some(7),
    Some(6),
    None,
    None,
    None,
    None,
    None,
    None,
];

const LSS: LssProfile = LssProfile {
    stopped_only: false,
    node_id: od_model::Address::new(0x2101, 0),
    bit_rate: od_model::Address::new(0x2100, 0),
    bit_rates: RATES,
    identify_remote: true,
    non_configured: true,
    fastscan: true,
    inquire_node_id: true,
    second_delay: false,
};

macro_rules! device {
    ($peer:expr) => {
        &mut Lent {
            dictionary: $peer.tables.dictionary(),
            values: &mut $peer.values,
            application: &mut $peer.application,
            storage: &mut $peer.storage,
            profile: Some(&$peer.profile),
        }
    };
}

fn tables(node: u8, identity: [u32; 4]) -> Tables {
    use DataType::*;
    let unsigned = |value: u32| Some(Value::Unsigned(value.into()));
    let mut rows = vec![
        (0x1000, 0, Unsigned32, Access::Ro, unsigned(0x0002_0196)),
        (0x1001, 0, Unsigned8, Access::Ro, unsigned(0)),
        (0x1017, 0, Unsigned16, Access::Rw, unsigned(0)),
        (0x1018, 0, Unsigned8, Access::Const, unsigned(4)),
        (0x2000, 0, Unsigned32, Access::Rw, unsigned(5)),
        (0x2001, 0, Unsigned64, Access::Rw, unsigned(7)),
        (
            0x2003,
            0,
            Domain,
            Access::Rw,
            Some(Value::Bytes(vec![0; ROOM])),
        ),
        (0x2004, 0, Domain, Access::Rw, None),
        (0x2100, 0, Unsigned8, Access::Rw, unsigned(2)),
        (0x2101, 0, Unsigned8, Access::Rw, unsigned(node.into())),
    ];
    for (sub, number) in (1..).zip(identity) {
        rows.push((0x1018, sub, Unsigned32, Access::Ro, unsigned(number)));
    }
    let mut description = Description::default();
    for (index, sub, data_type, access, default) in rows {
        let mut entry = EntryDescription::new(format!("{index:04X} {sub}"), data_type);
        entry.access = Spanned::from(access);
        entry.default = default.map(Spanned::from);
        let object = description
            .objects
            .entry(index)
            .or_insert_with(|| ObjectDescription::var(entry.clone()));
        if sub > 0 {
            object.code = Spanned::from(ObjectCode::Record);
        }
        object.entries.insert(sub, entry);
    }
    Tables::new(&description)
}

impl Peer {
    /// A node with power that has sent its boot-up message.
    pub(crate) fn new(node: u8, identity: [u32; 4]) -> Self {
        let tables = tables(node, identity);
        let mut peer = Self {
            values: vec![0; tables.dictionary().store_len()],
            tables,
            storage: Memory::new(vec![0xFF; 4 * ROOM]),
            profile: Profile {
                lss: Some(LSS),
                ..Profile::CIA301
            },
            node: Node::new(NodeId::ONE),
            application: Stored::default(),
        };
        peer.node
            .power_on(device!(peer), Instant::ZERO)
            .expect("the values fit");
        while peer.poll(Instant::ZERO).is_some() {}
        peer
    }

    fn handle(&mut self, now: Instant, frame: &Frame) {
        self.node.handle_frame(device!(self), now, frame);
    }

    fn timeout(&mut self, now: Instant) {
        self.node.handle_timeout(device!(self), now);
    }

    fn poll(&mut self, now: Instant) -> Option<Frame> {
        self.node.poll_transmit(device!(self), now)
    }
}

/// The client, its peers, and all frames so far.
pub(crate) struct Bus {
    pub(crate) client: Client,
    pub(crate) peers: Vec<Peer>,
    pub(crate) now: Instant,
    pub(crate) frames: Vec<String>,
    /// Does the bus lose this frame, the one of this number?
    pub(crate) loses: fn(usize, &Frame) -> bool,
}

impl Bus {
    pub(crate) fn new(client: Client, peers: Vec<Peer>) -> Self {
        Self {
            client,
            peers,
            now: Instant::ZERO,
            frames: Vec::new(),
            loses: |_, _| false,
        }
    }

    /// Node 1 only.
    pub(crate) fn one(client: Client) -> Self {
        Self::new(client, vec![Peer::new(1, [1, 2, 3, 4])])
    }

    /// One frame goes over the bus. The nodes' come first, so that the client sees its
    /// segments one by one.
    fn step(&mut self) -> bool {
        let Self { peers, now, .. } = self;
        let mut from = peers.iter_mut().map(|peer| peer.poll(*now)).enumerate();
        let sent = from.find_map(|(from, frame)| Some((Some(from), frame?)));
        let sent = sent.or_else(|| Some((None, self.client.poll_transmit(*now)?)));
        let Some((from, frame)) = sent else {
            return false;
        };
        let number = self.frames.len();
        self.frames.push(frame.to_string());
        if (self.loses)(number, &frame) {
            return true;
        }
        self.now = self.now.plus_micros(100);
        if from.is_some() {
            self.client.handle_frame(self.now, &frame);
        }
        for (at, peer) in self.peers.iter_mut().enumerate() {
            if from != Some(at) {
                peer.handle(self.now, &frame);
            }
        }
        true
    }

    /// Runs until nothing is sent and nothing is due before `end`.
    pub(crate) fn run_until(&mut self, end: Instant) {
        for turn in 0.. {
            while self.step() {
                assert!(self.frames.len() < 400_000, "frames without end");
            }
            assert!(turn < 10_000, "deadlines without end");
            let peers = self
                .peers
                .iter()
                .filter_map(|peer| peer.node.poll_timeout());
            let next = peers.chain(self.client.poll_timeout()).min();
            let Some(next) = next.filter(|at| *at <= end) else {
                break;
            };
            self.now = self.now.max(next);
            self.client.handle_timeout(self.now);
            for peer in &mut self.peers {
                peer.timeout(self.now);
            }
        }
        self.now = self.now.max(end);
    }

    /// Runs for a minute of virtual time; the events.
    pub(crate) fn run(&mut self) -> Vec<Event> {
        self.run_until(self.now.plus_millis(60_000));
        core::iter::from_fn(|| self.client.poll_event()).collect()
    }
}
