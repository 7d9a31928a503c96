//! Warnings of the rules about rows, and about those of a variant.
#![deny(deprecated)] // so that the warnings are in the expected output

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x2000 { name = "Gear"; type = u8; default = 30; high = 20 }
        add 0x2001 { name = "Name"; type = str; default = "grün" }
        add 0x1016 { code = array; name = "Consumer heartbeat time" }
        add 0x1016sub1 { name = "Consumer 1"; type = u32; access = rw; default = 0 }
        variant slow { modify 0x1017 { type = u32 } }
    }
}

fn main() {}
