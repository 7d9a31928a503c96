//! A node with room for one TPDO, and a dictionary with two.

use odkit::{NodeId, object_dictionary};

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1800 { code = record; name = "TPDO 1" }
        add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Transmission type"; type = u8; access = rw; default = 254 }
        add 0x1A00 { code = record; name = "TPDO 1 mapping" }
        add 0x1A00sub1 { name = "Entry 1"; type = u32; access = rw; default = 0x1001_0008 }
        add 0x1801 { code = record; name = "TPDO 2" }
        add 0x1801sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x280 }
        add 0x1801sub2 { name = "Transmission type"; type = u8; access = rw; default = 254 }
        add 0x1A01 { code = record; name = "TPDO 2 mapping" }
        add 0x1A01sub1 { name = "Entry 1"; type = u32; access = rw; default = 0x1001_0008 }
    }
}

static NODE: odkit::Node<device::Device, 1, 32> = odkit::Node::new(NodeId::ONE);

fn main() {
    println!("{}", NODE.node_id());
}
