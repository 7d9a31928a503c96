//! `crate = path;` says where the crate `odkit` is.

mod mine {
    pub mod vendored {
        pub use odkit as kit;
    }
}

odkit::object_dictionary! {
    pub mod device {
        crate = crate::under_another_path::mine::vendored::kit;
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 7 }
        variant other { modify 0x1018sub1 { default = 8 } }
    }
}

#[test]
fn compiles() {
    assert_eq!(device::DICTIONARY.objects().len(), 3);
    assert_eq!(device::identity_object::VENDOR_ID.address().sub, 1);
    assert_eq!(device::other::identity_object::VENDOR_ID.address().sub, 1);
}
