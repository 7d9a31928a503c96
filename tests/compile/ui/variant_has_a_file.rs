//! A file of its own in a variant.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x2000 { name = "Speed"; type = u16; access = rw; default = 3 }
        add 0x2001 { name = "Torque"; type = u16; access = rw; default = 4 }
        variant fast {
            eds = "fast.eds";
        }
    }
}

fn main() {}
