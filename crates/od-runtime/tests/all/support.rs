//! A node on a bench: frames in the notation of candump.
#![allow(dead_code, unreachable_pub)] // each test file uses its own part

use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Tables, Value};
use od_model::{Access, Address, DataType, ObjectCode};
use od_runtime::rooms::{LoadedRooms, LoadedValues};
use od_runtime::storage::Memory;
use od_runtime::{
    Application, BusEvent, CanId, Device, Frame, Instant, NoApplication, Node, NodeId, Profile,
    Services,
};

/// xorshift64*: the same numbers on every run.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 16
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.next() as usize % from.len()]
    }
}

/// One row of a dictionary: address, type, access, mappable, default.
pub type Row = (u16, u8, DataType, Access, bool, Option<Value>);

pub fn unsigned(value: u64) -> Option<Value> {
    Some(Value::Unsigned(value))
}

/// Objects that every node has, and some with which the services work.
pub fn rows() -> Vec<Row> {
    use Access::*;
    use DataType::*;
    let mut rows = vec![
        (0x1000, 0, Unsigned32, Ro, false, unsigned(0x0002_0196)),
        (0x1001, 0, Unsigned8, Ro, true, unsigned(0)),
        (0x1003, 0, Unsigned8, Rw, false, unsigned(0)),
        (0x1003, 1, Unsigned32, Ro, false, unsigned(0)),
        (0x1003, 2, Unsigned32, Ro, false, unsigned(0)),
        (0x1005, 0, Unsigned32, Rw, false, unsigned(0x80)),
        (
            0x1008,
            0,
            VisibleString,
            Const,
            false,
            Some(Value::Text("odkit test device".into())),
        ),
        (0x1010, 0, Unsigned8, Const, false, unsigned(1)),
        (0x1010, 1, Unsigned32, Rw, false, unsigned(1)),
        (0x1011, 0, Unsigned8, Const, false, unsigned(1)),
        (0x1011, 1, Unsigned32, Rw, false, unsigned(1)),
        (0x1014, 0, Unsigned32, Rw, false, Some(Value::NodeId(0x80))),
        (0x1017, 0, Unsigned16, Rw, false, unsigned(0)),
        (0x2000, 0, Unsigned32, Rw, true, unsigned(5)),
        (0x2001, 0, Integer16, Rw, true, Some(Value::Signed(-2))),
        (
            0x2002,
            0,
            VisibleString,
            Rw,
            false,
            Some(Value::Text("hello".into())),
        ),
        (0x2003, 0, Domain, Rw, false, None),
        (0x2004, 0, Unsigned8, Wo, false, unsigned(0)),
        (
            0x2005,
            0,
            Unsigned64,
            Rw,
            true,
            unsigned(0x0102_0304_0506_0708),
        ),
        (0x2006, 0, Boolean, Rw, true, unsigned(0)),
    ];
    for number in 0..2u16 {
        let (rx, tx) = (0x1400 + number, 0x1800 + number);
        rows.extend([
            (rx, 0, Unsigned8, Const, false, unsigned(2)),
            (
                rx,
                1,
                Unsigned32,
                Rw,
                false,
                Some(Value::NodeId(0x200 + 0x100 * u32::from(number))),
            ),
            (rx, 2, Unsigned8, Rw, false, unsigned(255)),
            (tx, 0, Unsigned8, Const, false, unsigned(6)),
            (
                tx,
                1,
                Unsigned32,
                Rw,
                false,
                Some(Value::NodeId(0x180 + 0x100 * u32::from(number))),
            ),
            (tx, 2, Unsigned8, Rw, false, unsigned(255)),
            (tx, 3, Unsigned16, Rw, false, unsigned(0)),
            (tx, 5, Unsigned16, Rw, false, unsigned(0)),
            (tx, 6, Unsigned8, Rw, false, unsigned(0)),
        ]);
        for (index, entry) in [
            (0x1600 + number, 0x2001_0010),
            (0x1A00 + number, 0x2000_0020),
        ] {
            rows.push((index, 0, Unsigned8, Rw, false, unsigned(1)));
            rows.push((index, 1, Unsigned32, Rw, false, unsigned(entry)));
            for sub in 2..=8 {
                rows.push((index, sub, Unsigned32, Rw, false, unsigned(0)));
            }
        }
    }
    rows
}

pub fn tables(rows: Vec<Row>) -> Tables {
    let mut description = Description::default();
    for (index, sub, data_type, access, mappable, default) in rows {
        let mut entry = EntryDescription::new(format!("{index:04X} {sub}"), data_type);
        entry.access = Spanned::from(access);
        entry.mappable = Spanned::from(mappable);
        entry.default = default.map(Spanned::from);
        if data_type == DataType::Domain {
            // As long as 73 segments of a block transfer.
            entry.capacity = Some(512);
        }
        if matches!((index, sub), (0x2000, 0)) {
            entry.low = Some(Spanned::from(Value::Unsigned(2)));
            entry.high = Some(Spanned::from(Value::Unsigned(1_000_000)));
        }
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

/// A device of tables that are made at run time.
pub trait Loaded: Device {
    fn of(tables: Tables) -> Self;
}

/// A device with every service; its dictionary is known at run time.
#[derive(Debug)]
pub struct Full {
    pub tables: Tables,
    pub profile: Profile,
}

impl Services for Full {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

impl Device for Full {
    type Values = LoadedValues;
    type Rooms = LoadedRooms;

    fn dictionary(&self) -> od_model::Dictionary<'_> {
        self.tables.dictionary()
    }

    fn profile(&self) -> &Profile {
        &self.profile
    }
}

impl Loaded for Full {
    fn of(tables: Tables) -> Self {
        let profile = Profile::CIA301;
        Self { tables, profile }
    }
}

/// A node and the time.
pub struct Bench<A = NoApplication, D: Device = Full> {
    pub node: Node<D, A, Memory<Vec<u8>>>,
    pub now: Instant,
}

impl Bench {
    /// Node 1 with [`rows`] and CiA 301 without deviations, before power-on.
    pub fn new() -> Self {
        Self::with(rows(), NoApplication)
    }
}

impl<A: Application> Bench<A> {
    pub fn with(rows: Vec<Row>, application: A) -> Self {
        Self::of_device(rows, application)
    }
}

impl<A: Application, D: Loaded> Bench<A, D> {
    /// As [`with`](Bench::with), for a device that need not have every service.
    pub fn of_device(rows: Vec<Row>, application: A) -> Self {
        Self::of_tables(tables(rows), application)
    }

    /// As [`of_device`](Self::of_device), with these tables.
    pub fn of_tables(tables: Tables, application: A) -> Self {
        let storage = Memory::new(vec![0xFF; 8192]);
        Self {
            node: Node::new(D::of(tables), NodeId::ONE, application, storage),
            now: Instant::ZERO,
        }
    }

    /// The same device with another node ID, before power-on.
    pub fn at(self, node_id: NodeId) -> Self {
        let (device, application, storage) = self.node.into_parts();
        Self {
            node: Node::new(device, node_id, application, storage),
            now: self.now,
        }
    }

    pub fn power_on(&mut self) -> Vec<String> {
        self.node.power_on(self.now);
        self.drain()
    }

    pub fn drain(&mut self) -> Vec<String> {
        let mut out = Vec::new();
        loop {
            let may = self.node.may_transmit();
            let Some(frame) = self.node.poll_transmit(self.now) else {
                return out;
            };
            assert!(may, "{frame} was not announced");
            out.push(frame.to_string());
        }
    }

    /// Receives a frame, `601#40…` or `181#R`; returns the frames that are sent.
    pub fn send(&mut self, text: &str) -> Vec<String> {
        self.hear(text);
        self.drain()
    }

    /// As [`send`](Self::send), for a slow host: no frame is sent.
    pub fn hear(&mut self, text: &str) {
        let (id, data) = text.split_once('#').expect("id#data");
        let raw = u32::from_str_radix(id, 16).expect("hex");
        let id = match id.len() {
            8 => CanId::extended(raw),
            _ => CanId::standard(raw as u16),
        };
        let frame = match data.strip_prefix('R') {
            Some(dlc) => Frame::remote(id, dlc.parse().unwrap_or(0)).expect("8 at most"),
            None => {
                let bytes: Vec<u8> = (0..data.len() / 2)
                    .map(|i| u8::from_str_radix(&data[2 * i..2 * i + 2], 16).expect("hex"))
                    .collect();
                Frame::new(id, &bytes).expect("eight bytes at most")
            }
        };
        self.node.handle_frame(self.now, &frame);
    }

    /// Returns the only response.
    pub fn ask(&mut self, text: &str) -> String {
        let mut out = self.send(text);
        assert_eq!(out.len(), 1, "{text} -> {out:?}");
        out.remove(0)
    }

    /// Lets time pass; returns the frames that are sent, each with its millisecond.
    pub fn wait(&mut self, millis: u64) -> Vec<(u64, String)> {
        let end = self.now.plus_millis(millis);
        let mut out = Vec::new();
        while let Some(at) = self.node.poll_timeout().filter(|at| *at <= end) {
            self.now = self.now.max(at);
            self.node.handle_timeout(self.now);
            let ms = self.now.as_micros() / 1000;
            out.extend(self.drain().into_iter().map(|frame| (ms, frame)));
        }
        self.now = end;
        out
    }

    /// Reports an event of the CAN controller; returns the frames that are sent.
    pub fn bus(&mut self, event: BusEvent) -> Vec<String> {
        self.node.handle_bus(self.now, event);
        self.drain()
    }

    /// Switches power off and on; returns the frames that are sent.
    pub fn power_cycle(&mut self) -> Vec<String> {
        self.node.power_off();
        self.node.storage.restore_power();
        self.power_on()
    }

    pub fn change(&mut self) -> Vec<String> {
        self.node.handle_change(self.now);
        self.drain()
    }

    pub fn value(&self, index: u16, sub: u8) -> u64 {
        let mut values = self.node.values().to_vec();
        let dictionary = self.node.device().dictionary();
        let store = od_runtime::Store::new(&dictionary, &mut values, self.node.node_id());
        store.expect("the values fit").unsigned(index, sub)
    }

    pub fn entry(&self, address: Address) -> od_model::Entry {
        self.node
            .device()
            .dictionary()
            .find(address)
            .expect("there")
    }
}
