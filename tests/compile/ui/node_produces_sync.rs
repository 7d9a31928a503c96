//! A dictionary that makes the device a SYNC producer.

use odkit::storage::NoStorage;
use odkit::{NoApplication, NodeId, object_dictionary};

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1005 { name = "COB-ID SYNC"; type = u32; access = rw; default = 0x4000_0080 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
    }
}

static NODE: device::Node<NoApplication, NoStorage> =
    odkit::Node::new(device::Device, NodeId::ONE, NoApplication, NoStorage);

fn main() {
    println!("{}", NODE.node_id());
}
