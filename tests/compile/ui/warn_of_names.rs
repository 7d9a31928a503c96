//! Names that repeat, and a keyword.
#![deny(deprecated)] // so that the warnings are in the expected output

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x2000 { name = "Speed"; type = u8 }
        add 0x2001 { name = "Speed"; type = u8 }
        add 0x2002 { code = record; name = "match" }
        add 0x2002sub1 { name = "Score"; type = u8 }
    }
}

fn main() { let _ = (device::SPEED, device::r#match::SCORE); }
