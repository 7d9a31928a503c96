//! A device without 1018h.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
    }
}

fn main() {}
