//! canopen-rs behind slcan over TCP: `canopen-rs-slave PORT NODE`. Its node leaves time, SYNC and resets to the application.

mod slcan;

use std::time::{Duration, Instant};

use canopen_rs::lss::LssAddress;
use canopen_rs::nmt::NmtState;
use canopen_rs::node::{Node, TxFrame};
use canopen_rs::standard::StandardObjects;
use canopen_rs::{Address, Entry, NodeId, ObjectDictionary, Value};

const IDENTITY: LssAddress = LssAddress {
    vendor_id: 1,
    product_code: 2,
    revision_number: 3,
    serial_number: 4,
};

/// A node with one TPDO of 2000h and one RPDO to 2001h.
fn made(id: NodeId) -> Box<Node<64>> {
    let mut od = ObjectDictionary::<64>::new();
    StandardObjects::new(0, IDENTITY)
        .with_error_history(4)
        .with_device_name("canopen-rs-slave")
        .insert_into(&mut od)
        .expect("64 entries");
    let mut insert = |index, sub, entry| {
        od.insert(Address::new(index, sub), entry)
            .expect("64 entries");
    };
    let own = u32::from(id.raw());
    for (number, cob_id, kind, mapped) in [
        (0x1400, 0x200 + own, 255, 0x2001_0020),
        (0x1800, 0x180 + own, 1, 0x2000_0020),
    ] {
        insert(number, 0, Entry::constant(Value::Unsigned8(2)));
        insert(number, 1, Entry::rw(Value::Unsigned32(cob_id)));
        insert(number, 2, Entry::rw(Value::Unsigned8(kind)));
        insert(number + 0x200, 0, Entry::rw(Value::Unsigned8(1)));
        insert(number + 0x200, 1, Entry::rw(Value::Unsigned32(mapped)));
    }
    insert(0x2000, 0, Entry::rw(Value::Unsigned32(4711)));
    insert(0x2001, 0, Entry::rw(Value::Unsigned32(0)));
    let mut node = Box::new(Node::new(id, od));
    node.enable_lss(IDENTITY);
    node.configure_pdos_from_od();
    node
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let mut bus = slcan::Bus::open(args[1].parse().expect("a port"));
    let id = NodeId::new(args[2].parse().expect("a number")).expect("a node ID");
    let mut node = made(id);
    let mut beat: Option<Instant> = None;
    let mut is_kept = false;
    node.boot();
    loop {
        let mut out: Vec<TxFrame> = Vec::new();
        if let Some(frame) = bus.next() {
            if frame.is_remote {
                if frame.id == 0x700 + u16::from(node.node_id().raw()) {
                    out.push(node.node_guard_response());
                }
            } else {
                // Reset communication (82h) keeps the values of the application.
                is_kept = frame.id == 0 && frame.data.first() == Some(&0x82);
                if frame.id == 0x80 {
                    out.extend(node.sync_tpdos());
                }
                out.extend(node.on_frame(frame.id, &frame.data));
                let written = node.take_written_object();
                if written.is_some_and(|address| (0x1400..=0x1BFF).contains(&address.index)) {
                    node.configure_pdos_from_od();
                }
                if written.is_some_and(|address| address.index == 0x1017) {
                    beat = None;
                }
            }
        }
        if node.state() == NmtState::Initialising {
            let pending = node.lss().map_or(id.raw(), |lss| lss.pending_node_id());
            let last = node;
            node = made(NodeId::new(pending).unwrap_or(id));
            for index in [0x2000, 0x2001].into_iter().filter(|_| is_kept) {
                let address = Address::new(index, 0);
                let value = last.od().read(address).expect("an object");
                node.od_mut().set(address, value).expect("an object");
            }
            out.push(node.boot());
            beat = None;
        }
        if let Ok(Value::Unsigned16(millis @ 1..)) = node.od().read(Address::new(0x1017, 0)) {
            let period = Duration::from_millis(millis.into());
            let due = *beat.get_or_insert_with(|| Instant::now() + period);
            if Instant::now() >= due {
                out.push(node.heartbeat());
                beat = Some(due + period);
            }
        }
        for frame in out {
            bus.send(frame.cob_id, false, frame.data());
        }
    }
}
