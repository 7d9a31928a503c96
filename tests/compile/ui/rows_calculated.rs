//! Values that would have to be calculated.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1014 { name = "COB-ID EMCY"; type = u32; default = $NODEID - 1 }
        add 0x2000 { name = "Size"; type = u16; access = rw; default = 2 * 64 }
        add 0x2001 { name = "Count"; type = u16; access = rw; default = 1 + 1 }
    }
}

fn main() {}
