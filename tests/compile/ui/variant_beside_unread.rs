//! A statement of one variant that cannot be read, beside a mistake about the same object in another variant.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x2000 { name = "Gain"; type = u8; access = rw; default = 1 }
        variant strong { modify 0x2000 { default = 256 } }
        variant other { modify 0x2000 { type = u15 } }
        variant lost { modify gain { default = 2 } }
        variant weak { modify 0x2001 { default = 1 } }
    }
}

fn main() {}
