//! The path of the crate `odkit` is wrong: one error, at the path.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        crate = ::wrong;
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x2000 { name = "Gain"; type = f64; access = rw; default = 1.5 }
        add 0x2001 { name = "Name"; type = str; access = rw; default = "x" }
        variant other { modify 0x2000 { default = 2.5 } }
    }
}

fn main() {
    let _ = (device::GAIN.address(), device::other::NAME, device::identity_object::VENDOR_ID);
    let _: Option<device::Node> = None;
}
