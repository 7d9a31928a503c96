//! Services that objects of the table need.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1010 { code = array; name = "Store parameters" }
        add 0x1010sub1 { name = "Save all"; type = u32; access = rw; default = 1 }
        add 0x1400 { code = record; name = "RPDO 1" }
        add 0x1400sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x200 }
        add 0x1400sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
        add 0x1600 { code = record; name = "Mapping 1" }
        add 0x1600sub1 { name = "Mapped object 1"; type = u32; access = rw; default = 0x2000_0010 }
        add 0x2000 { name = "Target"; type = u16; access = rww; mappable = true }
        without rpdos, storage;
    }
}

fn main() { let _ = device::Device; }
