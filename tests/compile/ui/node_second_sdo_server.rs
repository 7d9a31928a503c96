//! A dictionary with a second SDO server, and a node that has no room for it.

use odkit::{NodeId, object_dictionary};

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1201 { code = record; name = "SDO server 2" }
        add 0x1201sub1 { name = "COB-ID request"; type = u32; access = rw; default = 0x6A0 }
        add 0x1201sub2 { name = "COB-ID response"; type = u32; access = rw; default = 0x6B0 }
    }
}

static NODE: odkit::Node<device::Device, 0, 32> = odkit::Node::new(NodeId::ONE);

fn main() {
    println!("{}", NODE.node_id());
}
