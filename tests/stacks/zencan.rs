//! zencan-node behind slcan over TCP: `zencan-slave PORT NODE`.

mod slcan;

use std::time::Instant;

use zencan_node::common::NodeId;
use zencan_node::common::messages::{CanId, CanMessage};
use zencan_node::{Callbacks, Node};

mod od {
    zencan_node::include_modules!(SLAVE);
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let mut bus = slcan::Bus::open(args[1].parse().expect("a port"));
    let node_id = NodeId::new(args[2].parse().expect("a number")).expect("a node ID");
    let mailbox = &od::NODE_MBOX;
    let mut node = Node::new(
        node_id,
        Callbacks::default(),
        mailbox,
        &od::NODE_STATE,
        &od::OD_TABLE,
    );
    let begin = Instant::now();
    loop {
        if let Some(frame) = bus.next() {
            let id = CanId::std(frame.id);
            let _ = mailbox.store_message(if frame.is_remote {
                CanMessage::new_rtr(id)
            } else {
                CanMessage::new(id, &frame.data)
            });
        }
        node.process(begin.elapsed().as_micros() as u64);
        while let Some(frame) = mailbox.next_transmit_message() {
            bus.send(frame.id().raw() as u16, frame.is_rtr(), frame.data());
        }
    }
}
