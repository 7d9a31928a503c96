//! A client and nodes of `od-runtime` on one bus, in virtual time.

use od_client::{Client, Event, Frame, Instant, NodeId};
use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Tables, Value};
use od_model::{Access, Address, DataType, Dictionary, ObjectCode};
use od_runtime::rooms::{LoadedRooms, LoadedValues};
use od_runtime::storage::Memory;
use od_runtime::{
    AbortCode, Application, Chunk, Context, Device, Halt, LssProfile, Node, Profile, Services,
    Store, Stream,
};

use super::pattern_at;

/// Greatest number of bytes of object 2003h.
pub(crate) const ROOM: usize = 8192;

/// One device on the bus.
pub(crate) type Peer = Node<Loaded, Stored, Memory<Vec<u8>>>;

/// A dictionary that is made at run time.
pub(crate) struct Loaded {
    tables: Tables,
    pub(crate) profile: Profile,
}

impl Services for Loaded {}

impl Device for Loaded {
    type Values = LoadedValues;
    type Rooms = LoadedRooms;

    fn dictionary(&self) -> Dictionary<'_> {
        self.tables.dictionary()
    }

    fn profile(&self) -> &Profile {
        &self.profile
    }
}

/// The node starts with the node ID in 2101h. The value of 2004h is [`pattern`]; the application
/// only ever has a part of it.
#[derive(Default)]
pub(crate) struct Stored {
    /// Length of 2004h in bytes.
    pub(crate) len: usize,
    /// Length of the largest part in bytes.
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
    shows_state: true,
};

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

/// A node with power that has sent its boot-up message.
pub(crate) fn peer(node: u8, identity: [u32; 4]) -> Peer {
    let device = Loaded {
        tables: tables(node, identity),
        profile: Profile {
            lss: Some(LSS),
            ..Profile::CIA301
        },
    };
    let storage = Memory::new(vec![0xFF; 4 * ROOM]);
    let mut peer = Node::new(device, NodeId::ONE, Stored::default(), storage);
    peer.power_on(Instant::ZERO);
    while peer.poll_transmit(Instant::ZERO).is_some() {}
    peer
}

/// The client, its peers, and all frames so far.
pub(crate) struct Bus {
    pub(crate) client: Client,
    pub(crate) peers: Vec<Peer>,
    pub(crate) now: Instant,
    pub(crate) frames: Vec<String>,
    /// Returns whether the bus loses this frame, given its number.
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
        Self::new(client, vec![peer(1, [1, 2, 3, 4])])
    }

    /// Moves one frame over the bus. Frames of the nodes come first, so that the client sees their
    /// segments one by one.
    fn step(&mut self) -> bool {
        let Self { peers, now, .. } = self;
        let mut from = peers
            .iter_mut()
            .map(|peer| peer.poll_transmit(*now))
            .enumerate();
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
                peer.handle_frame(self.now, &frame);
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
            let peers = self.peers.iter().filter_map(Peer::poll_timeout);
            let next = peers.chain(self.client.poll_timeout()).min();
            let Some(next) = next.filter(|at| *at <= end) else {
                break;
            };
            self.now = self.now.max(next);
            self.client.handle_timeout(self.now);
            for peer in &mut self.peers {
                peer.handle_timeout(self.now);
            }
        }
        self.now = self.now.max(end);
    }

    /// Runs for a minute of virtual time; returns the events.
    pub(crate) fn run(&mut self) -> Vec<Event> {
        self.run_until(self.now.plus_millis(60_000));
        core::iter::from_fn(|| self.client.poll_event()).collect()
    }
}
