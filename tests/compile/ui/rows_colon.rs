//! A sub-index after a colon, as logs write it.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1018:02 { name = "Product code"; type = u32 }
    }
}

fn main() {}
