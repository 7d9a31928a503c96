//! Services that are misspelt, unknown, and given twice.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        without lsss, gateway, lss, lss;
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 1 }
    }
}

fn main() {}
