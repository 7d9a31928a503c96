//! A mapping of an object that does not exist.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1800 { code = record; name = "TPDO 1" }
        add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Type"; type = u8; access = rw; default = 255 }
        add 0x1A00 { code = record; name = "TPDO 1 mapping" }
        add 0x1A00sub1 { name = "First"; type = u32; default = 0x6004_0020 }
    }
}

fn main() {}
