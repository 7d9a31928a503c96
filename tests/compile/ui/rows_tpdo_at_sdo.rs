//! A TPDO with the CAN-ID of the SDO of node 1.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1800 { code = record; name = "TPDO 1" }
        add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = 0x601 }
        add 0x1800sub2 { name = "Transmission type"; type = u8; access = rw; default = 255 }
        add 0x1A00 { code = record; name = "Mapping 1" }
        add 0x1A00sub1 { name = "Mapped object 1"; type = u32; access = rw; default = 0x1001_0008 }
    }
}

fn main() {}
