//! The call as part of another macro, where `$` cannot be used.

use odkit::object_dictionary;

macro_rules! device {
    ($name:ident, $offset:literal) => {
        object_dictionary! {
            mod $name {
                add 0x1000 { name = "Device type"; type = u32; default = 0 }
                add 0x1001 { name = "Error register"; type = u8 }
                add 0x1014 { name = "COB-ID EMCY"; type = u32; access = rw; default = NODEID + 0x80 }
                add 0x1018 { code = record; name = "Identity object" }
                add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = $offset }
            }
        }
    };
}
device!(left, 1);
device!(right, 2);

#[test]
fn compiles() {
    assert_ne!(left::DICTIONARY, right::DICTIONARY);
    let _ = left::COB_ID_EMCY;
}
