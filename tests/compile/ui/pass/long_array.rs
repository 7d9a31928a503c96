//! A long ARRAY has one constant for its sub-objects, and those that the call renames.

use odkit::object_dictionary;

macro_rules! table {
    ($($row:literal)*) => {
        object_dictionary! {
            mod device {
                add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
                add 0x1001 { name = "Error register"; type = u8; mappable = true }
                add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
                add 0x1018 { code = record; name = "Identity object" }
                add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
                add 0x2000 { code = array; name = "Samples" }
                $(add $row { name = "Sample"; type = u16; access = rw; mappable = true })*
                rename 0x2000sub3 = THIRD;
                variant other { modify 0x2000sub2 { access = ro } }
            }
        }
    };
}

table! {
    0x2000sub01 0x2000sub02 0x2000sub03 0x2000sub04 0x2000sub05 0x2000sub06 0x2000sub07 0x2000sub08
    0x2000sub09 0x2000sub0A 0x2000sub0B 0x2000sub0C 0x2000sub0D 0x2000sub0E 0x2000sub0F 0x2000sub10
    0x2000sub11 0x2000sub12 0x2000sub13 0x2000sub14 0x2000sub15 0x2000sub16 0x2000sub17 0x2000sub18
    0x2000sub19 0x2000sub1A 0x2000sub1B 0x2000sub1C 0x2000sub1D 0x2000sub1E 0x2000sub1F 0x2000sub20
    0x2000sub21 0x2000sub22 0x2000sub23 0x2000sub24 0x2000sub25 0x2000sub26 0x2000sub27 0x2000sub28
    0x2000sub29 0x2000sub2A 0x2000sub2B 0x2000sub2C 0x2000sub2D 0x2000sub2E 0x2000sub2F 0x2000sub30
    0x2000sub31 0x2000sub32 0x2000sub33 0x2000sub34 0x2000sub35 0x2000sub36 0x2000sub37 0x2000sub38
    0x2000sub39 0x2000sub3A 0x2000sub3B 0x2000sub3C 0x2000sub3D 0x2000sub3E 0x2000sub3F 0x2000sub40
    0x2000sub41 0x2000sub42
}

#[test]
fn each_sub_index_has_its_handle() {
    let samples = device::samples::ENTRIES;
    assert_eq!(samples.count(), 0x42);
    for handle in samples.iter() {
        let address = handle.address();
        let entry = device::DICTIONARY
            .entry(address.index, address.sub)
            .unwrap();
        assert_eq!((entry.slot, entry.mappable), (handle.slot(), true));
    }
    let third = device::samples::THIRD;
    assert_eq!(samples.at(3).unwrap().slot(), third.slot());
    // If they are not all alike, each has a constant.
    assert_eq!(device::other::samples::SAMPLE_02.address().sub, 2);
    assert_eq!(device::other::samples::SAMPLE_42.address().sub, 0x42);
}
