//! A new name that the module uses itself.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        rename 0x1001 = DICTIONARY;
    }
}

fn main() {}
