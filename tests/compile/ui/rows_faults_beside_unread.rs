//! Statements that cannot be read hide no mistake of others, and no warning.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        profile = cia406;
        add 0x2000 { name = "Speed"; type = u16; access = rw; mappable = true; default = 0 }
        ad 0x2001 { name = "Torque"; type = u16 }
        add 0x2002 { name = "Gear"; type = u8; access = rw; defualt = 3 }
        add 0x2003 { cod = record; name = "Motor" }
        add 0x2003sub1 { name = "Pole pairs"; type = u8; access = rw; default = 300 }
        add 0x1800 { code = record; name = "TPDO 1" }
        add 0x1800sub1 { name = "COB-ID of TPDO 1"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Transmission type of TPDO 1"; type = u8; access = rw; default = 250 }
        add 0x1A00 { code = record; name = "TPDO 1 mapping" }
        add 0x1A00sub1 { name = "Entry of TPDO 1"; type = u32; access = rw; default = 0x2000_0010 }
        add 0x1801 { code = record; name = "TPDO 2" }
        add 0x1801sub1 { name = "COB-ID of TPDO 2"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1801sub2 { name = "Transmission type of TPDO 2"; type = u8; access = rw; default = 254 }
        add 0x1A01 { code = record; name = "TPDO 2 mapping" }
        add 0x1A01sub1 { name = "Entry of TPDO 2"; type = u32; access = rw; default = 0x2000_0010 }
        rename 0x2000 = speed;
        rename 0x2009 = LOST;
        variant wide { modify 0x1800sub1 { default = $NODEID + 0x790 } }
    }
}

fn main() {}
