//! Whether what comes all day takes the shorter way: from outside it looks like the other one.

use std::vec;
use std::vec::Vec;

use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Tables, Value};
use od_model::{Access, Address, DataType, ObjectCode};
use od_wire::nmt::State;
use od_wire::{AbortCode, CanId, NodeId};

use super::super::ear::{ERROR_CONTROL, LSS, NMT, NONE, code};
use super::*;
use crate::application::Application;
use crate::device::AnyDevice;
use crate::profile::Profile;
use crate::storage::NoStorage;

/// 2001h is live.
#[derive(Default)]
struct Live {
    reads: u8,
    raises: bool,
    fails: bool,
    /// The value, if it is at hand.
    at_hand: Option<u32>,
}

impl Application for Live {
    fn is_live(&self, address: Address) -> bool {
        address.index == 0x2001
    }

    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        assert_eq!(address.index, 0x2001, "no other is live");
        self.reads += 1;
        cx.store.set_unsigned(address, self.reads.into());
        if self.raises {
            cx.signals.wake();
        }
        match self.fails {
            true => Err(AbortCode::DeviceState),
            false => Ok(()),
        }
    }

    fn number(&mut self, _: Instant, address: Address) -> Option<u32> {
        assert_eq!(address.index, 0x2001, "no other is live");
        self.at_hand
    }
}

struct Bench {
    tables: Tables,
    values: Vec<u8>,
    live: Live,
    profile: Profile,
    node: Node<AnyDevice, 6, 128>,
}

/// Calls the node with its device.
macro_rules! call {
    ($bench:ident.$call:ident $(, $argument:expr)*) => {{
        let mut device = Lent {
            dictionary: $bench.tables.dictionary(),
            values: &mut $bench.values,
            application: &mut $bench.live,
            storage: &mut NoStorage,
            profile: Some(&$bench.profile),
        };
        $bench.node.$call(&mut device $(, $argument)*)
    }};
}

mod marks;
mod numbers;
mod ticks;

/// TPDOs of these types, the first one with 2000h and the others with `others`; RPDO 1.
fn bench(types: &[u64], others: u16) -> Bench {
    use Access::{Const, Ro, Rw};
    use DataType::{Unsigned8, Unsigned16, Unsigned32, VisibleString};
    let mut description = Description::default();
    let mut add = |index: u16, sub: u8, data_type, access, default| {
        let mut entry = EntryDescription::new("Value", data_type);
        entry.access = Spanned::from(access);
        entry.mappable = Spanned::from(index >= 0x2000);
        entry.default = Some(Spanned::from(default));
        let objects = &mut description.objects;
        let object = objects
            .entry(index)
            .or_insert_with(|| ObjectDescription::var(entry.clone()));
        if sub > 0 {
            object.code = Spanned::from(ObjectCode::Record);
        }
        object.entries.insert(sub, entry);
    };
    let number = Value::Unsigned;
    add(0x1000, 0, Unsigned32, Ro, number(0x1234));
    add(0x1001, 0, Unsigned8, Ro, number(0));
    add(0x1003, 0, Unsigned8, Rw, number(0));
    add(0x1005, 0, Unsigned32, Rw, number(0x80));
    add(
        0x1008,
        0,
        VisibleString,
        Const,
        Value::Text("device".into()),
    );
    add(0x1017, 0, Unsigned16, Rw, number(0));
    add(0x1200, 1, Unsigned32, Const, number(0x601));
    add(0x2000, 0, Unsigned16, Rw, number(5));
    add(0x2001, 0, Unsigned8, Rw, number(0));
    // One load reads four bytes, so there have to be some behind the last number.
    add(0x2010, 0, Unsigned32, Rw, number(0));
    add(0x1400, 1, Unsigned32, Rw, Value::NodeId(0x200));
    add(0x1400, 2, Unsigned8, Rw, number(1));
    add(0x1600, 0, Unsigned8, Rw, number(1));
    add(0x1600, 1, Unsigned32, Rw, number(0x2000_0010));
    for (at, kind) in (0..).zip(types) {
        let mapped = if at == 0 {
            0x2000_0010
        } else {
            u64::from(others) << 16 | 8
        };
        add(
            0x1800 + at,
            1,
            Unsigned32,
            Rw,
            Value::NodeId(0x180 + 0x100 * u32::from(at % 4) + 0x80 * u32::from(at / 4)),
        );
        add(0x1800 + at, 2, Unsigned8, Rw, number(*kind));
        add(0x1800 + at, 5, Unsigned16, Rw, number(10));
        add(0x1A00 + at, 0, Unsigned8, Rw, number(1));
        add(0x1A00 + at, 1, Unsigned32, Rw, number(mapped));
    }
    let tables = Tables::new(&description);
    let mut bench = Bench {
        values: vec![0; tables.dictionary().store_len()],
        tables,
        live: Live::default(),
        profile: Profile::CIA301,
        node: Node::new(NodeId::ONE),
    };
    bench.profile.pdo.event_on_change = false;
    call!(bench.power_on, Instant::ZERO).expect("it fits");
    drain(&mut bench);
    bench
}

/// Operational, and nothing waits.
fn running(types: &[u64], others: u16) -> Bench {
    let mut bench = bench(types, others);
    hear(&mut bench, 0, &[1, 1]);
    drain(&mut bench);
    assert_eq!(bench.node.machines.pending, 0);
    bench
}

fn hear<const N: usize>(bench: &mut Bench, id: u16, data: &[u8; N]) {
    let frame = Frame::standard(id, data);
    call!(bench.handle_frame, Instant::ZERO, &frame);
}

fn drain(bench: &mut Bench) -> Vec<Frame> {
    core::iter::from_fn(|| call!(bench.poll_transmit, Instant::ZERO)).collect()
}

fn request(index: u16, sub: u8) -> Frame {
    let [low, high] = index.to_le_bytes();
    Frame::standard(0x601, &[0x40, low, high, sub, 0, 0, 0, 0])
}

/// Whether an upload takes the short way.
fn is_short(bench: &mut Bench, index: u16, sub: u8) -> bool {
    let mut device = Lent {
        dictionary: bench.tables.dictionary(),
        values: &mut bench.values,
        application: &mut bench.live,
        storage: &mut NoStorage,
        profile: Some(&bench.profile),
    };
    let way = bench.node.upload(&mut device, &request(index, sub));
    !matches!(way, Upload::Other)
}

#[test]
fn a_number_is_uploaded_the_short_way() {
    let mut bench = bench(&[], 0);
    let response = |bytes: [u8; 8]| vec![Frame::standard(0x581, &bytes)];
    assert!(is_short(&mut bench, 0x2000, 0));
    assert_eq!(bench.node.machines.pending, pending::ANSWER);
    assert_eq!(bench.live.reads, 0);
    assert!(!is_short(&mut bench, 0x1000, 0), "an answer waits");
    assert_eq!(drain(&mut bench), response([0x4B, 0, 0x20, 0, 5, 0, 0, 0]));
    assert!(is_short(&mut bench, 0x1000, 0));
    assert_eq!(
        drain(&mut bench),
        response([0x43, 0, 0x10, 0, 0x34, 0x12, 0, 0])
    );
    assert!(is_short(&mut bench, 0x1001, 0));
    drain(&mut bench);
    for (index, sub) in [
        (0x1003, 0),
        (0x1008, 0),
        (0x1200, 1),
        (0x2000, 1),
        (0x2002, 0),
    ] {
        assert!(!is_short(&mut bench, index, sub), "{index:X}");
        assert_eq!(bench.node.machines.pending, 0, "nothing was done");
    }
    bench.node.machines.pending = pending::OTHER;
    assert!(!is_short(&mut bench, 0x2000, 0), "another frame waits");
    bench.node.machines.pending = pending::PDO;
    assert!(is_short(&mut bench, 0x2000, 0), "a PDO may wait");
    drain(&mut bench);
    bench.values.pop();
    assert!(!is_short(&mut bench, 0x2000, 0), "too few values");
}

#[test]
fn a_live_number_is_uploaded_the_short_way() {
    let mut bench = bench(&[], 0);
    let ask = |bench: &mut Bench| {
        assert!(is_short(bench, 0x2001, 0));
        call!(bench.handle_frame, Instant::ZERO, &request(0x2001, 0));
    };
    ask(&mut bench);
    assert_eq!(
        (bench.live.reads, bench.node.machines.pending),
        (1, pending::ANSWER)
    );
    let frame = Frame::standard(0x581, &[0x4F, 1, 0x20, 0, 1, 0, 0, 0]);
    assert_eq!(drain(&mut bench), [frame]);
    bench.live.fails = true;
    ask(&mut bench);
    let frame = Frame::standard(0x581, &[0x80, 1, 0x20, 0, 0x22, 0, 0, 8]);
    assert_eq!(drain(&mut bench), [frame]);
    bench.live.raises = true;
    ask(&mut bench);
    assert_ne!(
        bench.node.machines.pending & pending::OTHER,
        0,
        "more to do"
    );
    assert_eq!(drain(&mut bench).len(), 1);
}

#[test]
fn requests_are_short_while_the_node_listens_for_some_frames_only() {
    let mut bench = bench(&[], 0);
    hear(&mut bench, 0, &[2, 1]);
    drain(&mut bench);
    assert!(!bench.node.machines.quick.requests, "Stopped");
    assert!(!is_short(&mut bench, 0x2000, 0));
    hear(&mut bench, 0, &[0x80, 1]);
    drain(&mut bench);
    assert!(bench.node.machines.quick.requests);
    let mut bench = running(&[1, 1], 0x2001);
    assert!(bench.node.machines.quick.requests);
    assert!(is_short(&mut bench, 0x2000, 0));
}

#[test]
fn a_sync_marks_the_tpdos_that_each_one_sends() {
    const FIRST: u8 = pending::FIRST_MARK;
    for (types, others, marks) in [
        (&[1][..], 0x2000, FIRST),
        (&[1, 1], 0x2000, FIRST * 3),
        (&[254, 1, 255], 0x2000, FIRST * 2),
        (&[1, 1, 1, 1, 1], 0x2000, pending::MARKS),
        (&[1, 1, 1, 1, 1, 255], 0x2000, pending::MARKS),
        (&[1, 1, 1, 1, 1, 1], 0x2000, 0),
        (&[1, 2], 0x2000, 0),
        (&[254, 255], 0x2000, 0),
    ] {
        // 2000h is too long for the others, so they map their first byte's object.
        let others = if others == 0x2000 { 0x2001 } else { others };
        let bench = running(types, others);
        let quick = bench.node.machines.quick;
        assert_eq!((quick.syncs, quick.marks), (true, marks), "{types:?}");
    }
    for types in [&[0][..], &[1, 252], &[0, 1]] {
        let bench = running(types, 0x2001);
        let quick = bench.node.machines.quick;
        assert_eq!((quick.syncs, quick.marks), (false, 0), "{types:?}");
    }
    assert!(!bench(&[1], 0).node.machines.quick.syncs, "not Operational");
}

#[test]
fn marked_tpdos_are_sent_without_the_machines() {
    let mut bench = running(&[1, 1, 255, 1], 0x2001);
    bench.live.reads = 0;
    hear(&mut bench, 0x80, &[]);
    let mut send = || {
        let frame = call!(bench.poll_transmit, Instant::ZERO);
        (
            frame.map(|frame| frame.id().raw()),
            bench.node.machines.pending,
        )
    };
    const FIRST: u8 = pending::FIRST_MARK;
    assert_eq!(send(), (Some(0x181), FIRST * 10));
    assert_eq!(send(), (Some(0x281), FIRST * 8));
    assert_eq!(send(), (Some(0x481), 0));
    assert_eq!(send(), (None, 0));
    assert_eq!(bench.live.reads, 2, "once for each that maps it");
}

#[test]
fn a_call_takes_the_marks_for_what_they_are() {
    let mut bench = running(&[1, 255, 1], 0x2001);
    hear(&mut bench, 0x80, &[]);
    call!(bench.handle_change, Instant::ZERO);
    let node = &bench.node.machines;
    assert_eq!(node.pending, pending::PDO | pending::OTHER);
    let waiting: Vec<bool> = node.tpdos().iter().map(pdo::Tpdo::is_pending).collect();
    assert_eq!(waiting, [true, false, true]);
    assert_eq!(drain(&mut bench).len(), 2);
    assert_eq!(bench.node.machines.pending, 0);
}

#[test]
fn a_sync_counts_where_it_does_not_send_each_time() {
    let mut bench = running(&[2, 255], 0x2001);
    hear(&mut bench, 0x80, &[]);
    assert_eq!(bench.node.machines.pending, 0, "counted");
    hear(&mut bench, 0x80, &[7]);
    assert_eq!(bench.node.machines.pending, pending::PDO);
    assert_eq!(drain(&mut bench).len(), 1);
    hear(&mut bench, 0x80, &[7, 7]);
    assert_eq!(bench.node.machines.pending, pending::OTHER, "looked at");
    assert_eq!(drain(&mut bench), []);
}

#[test]
fn an_rpdo_that_waits_for_sync_makes_it_more_than_a_count() {
    let mut bench = running(&[1], 0);
    assert!(bench.node.machines.quick.syncs);
    hear(&mut bench, 0x201, &[9, 0]);
    drain(&mut bench);
    assert!(
        !bench.node.machines.quick.syncs,
        "2000h is sampled at the next"
    );
    hear(&mut bench, 0x80, &[]);
    let frame = Frame::standard(0x181, &[9, 0]);
    assert_eq!(drain(&mut bench), [frame]);
    assert!(bench.node.machines.quick.syncs);
}

#[test]
fn a_node_listens_for_what_its_state_has() {
    let mut bench = bench(&[1, 255], 0x2001);
    let heard = |bench: &Bench| {
        let ear = bench.node.machines.ear;
        (ear.sdo, ear.sync, ear.codes)
    };
    let own = NMT | ERROR_CONTROL;
    let (request, sync) = (CanId::standard(0x601), CanId::standard(0x80));
    assert_eq!(heard(&bench), (request, NONE, own));
    hear(&mut bench, 0, &[1, 1]);
    drain(&mut bench);
    let pdos = [0x181, 0x281, 0x201].map(|id| code(CanId::standard(id)));
    let pdos = pdos.into_iter().fold(own, |codes, code| codes | code);
    assert_eq!(heard(&bench), (request, sync, pdos));
    for (id, is_heard) in [
        (0, true),
        (0x80, true),
        (0x81, false),
        (0x100, false),
        (0x181, true),
        (0x1FF, true),
        (0x381, false),
        (0x601, true),
        (0x602, false),
        (0x701, true),
        (0x7E5, false),
    ] {
        let hears = bench.node.machines.ear.hears(CanId::standard(id));
        assert_eq!(hears, is_heard, "{id:X}");
    }
    hear(&mut bench, 0, &[2, 1]);
    drain(&mut bench);
    assert_eq!(bench.node.state(), State::Stopped);
    assert_eq!(heard(&bench), (NONE, NONE, own));
    bench.profile.lss = Some(crate::profile::LssProfile::CIA305);
    hear(&mut bench, 0, &[0x80, 1]);
    assert_eq!(heard(&bench), (request, NONE, own | LSS));
}
