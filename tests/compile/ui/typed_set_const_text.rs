//! A change of a `const` text.

use odkit::object_dictionary;
use od_runtime::Store;

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1008 { name = "Device name"; type = str; access = const; default = "x" }
        add 0x2000 { name = "Speed"; type = u16; access = rw; default = 3 }
        add 0x2001 { name = "Serial"; type = u32; access = const; default = 4 }
        add 0x2002 { name = "Alias"; type = str; access = rw }
        add 0x6004 { name = "Position"; type = u64; mappable = true }
    }
}

fn application(store: &mut Store<'_>) {
    let _ = store.set_text(device::DEVICE_NAME, b"y");
}

fn main() {}
