//! A sub-index after a space or a slash, and several objects in one statement.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1018 sub2 { name = "Product code"; type = u32 }
        add 0x1018/3 { name = "Revision number"; type = u32 }
        add 0x2000..0x2003 { name = "Speed"; type = u16; access = rw; default = 0 }
    }
}

fn main() {}
