//! A dictionary with an object of a service that is switched off.

use odkit::storage::NoStorage;
use odkit::{NoApplication, NodeId, object_dictionary};

object_dictionary! {
    mod device {
        without lss, consumer;
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1016 { code = array; name = "Consumer heartbeat time" }
        add 0x1016sub1 { name = "Consumer heartbeat time 1"; type = u32; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 1 }
    }
}

static NODE: device::Node<NoApplication, NoStorage> =
    odkit::Node::new(device::Device, NodeId::ONE, NoApplication, NoStorage);

fn main() {
    println!("{}", NODE.node_id());
}
