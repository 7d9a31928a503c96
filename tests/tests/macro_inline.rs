//! A dictionary from rows only, and its handles.

use od_model::typed::{Const, Mapping, Pdo, Ro, Rw, Text, Var, pdo};
use od_model::{Access, Address, DataType, Group, Literal, ObjectCode};
use odkit::object_dictionary;

object_dictionary! {
    /// A device without a file.
    pub mod bench {
        warnings = off;
        profile = cia406;
        rename 0x6004 = POSITION;
        rename 0x1018 = identity;

        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0x0001_0196 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true; default = 0 }
        add 0x1008 { name = "Manufacturer device name"; type = str; access = const; default = "GX µ \"1\"" }
        add 0x1014 { name = "COB-ID EMCY"; type = u32; access = rw; default = $NODEID + 0x80 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1018sub2 { name = "Reserved"; type = u32 }
        add 0x1018sub3 { name = "Reserved"; type = u32; default = NODEID }
        add 0x2100 { code = array; name = "Gear" }
        add 0x2100sub0 { name = "Length"; type = u8; access = const; default = 2 }
        add 0x2100sub1 { name = "kHz"; type = i8; access = rw; default = -3; low = -5; high = 5; save = none }
        add 0x2100sub2 { name = "Type"; type = INTEGER24; access = rw; save = application; };
        add 0x2101 { name = "Gain"; type = f32; access = rw; default = 1.5; low = -2 }
        add 0x2102 { name = "Key"; type = OCTET_STRING; access = rw; default = b"\x00\xFF\"" }
        add 0x2103 { name = "Enabled"; type = bool; access = rw; default = true; mappable = true }
        add 0x6004 { name = "Position value"; type = u32; mappable = true }
    }
}

const TPDO1: Mapping<3> = pdo([
    bench::POSITION.map(),
    bench::ERROR_REGISTER.map(),
    bench::ENABLED.map(),
]);

#[test]
fn handles_are_typed_and_named() {
    let _: Var<u32, Const> = bench::DEVICE_TYPE;
    let _: Var<u32, Ro, Pdo> = bench::POSITION;
    let _: Text<Const> = bench::MANUFACTURER_DEVICE_NAME;
    let _: Var<u32, Ro> = bench::identity::RESERVED_02;
    let _: Var<u32, Ro> = bench::identity::RESERVED_03;
    let _: Var<u8, Const> = bench::identity::HIGHEST_SUB_INDEX_SUPPORTED;
    let _: Var<i8, Rw> = bench::gear::KHZ;
    let _: Var<i32, Rw> = bench::gear::TYPE;
    let _: Var<f32, Rw> = bench::GAIN;
    let _: Text<Rw> = bench::KEY;
    assert_eq!(bench::gear::KHZ.address(), Address::new(0x2100, 1));
    assert_eq!(TPDO1.entries().map(|e| e.bits), [32, 8, 1]);
}

#[test]
fn an_address_is_matched_against_handles() {
    let name = |index, sub| match Address::new(index, sub) {
        bench::POSITION::ADDRESS => "position",
        bench::identity::VENDOR_ID::ADDRESS | bench::identity::RESERVED_03::ADDRESS => "identity",
        bench::KEY::ADDRESS => "key",
        _ => "other",
    };
    assert_eq!(name(0x6004, 0), "position");
    assert_eq!(name(0x1018, 1), "identity");
    assert_eq!(name(0x1018, 3), "identity");
    assert_eq!(name(0x2102, 0), "key");
    assert_eq!(name(0x1018, 2), "other");
    assert_eq!(name(0x6004, 1), "other");
    assert!(Address::new(0x6004, 0) == bench::POSITION && Address::new(0x2102, 0) == bench::KEY);
    assert!(Address::new(0x6004, 1) != bench::POSITION && Address::new(0x2102, 1) != bench::KEY);
}

#[test]
fn the_rows_contain_all_objects() {
    let d = bench::DICTIONARY;
    let identity = d.object(0x1018).unwrap();
    assert_eq!(identity.code, ObjectCode::Record);
    assert_eq!(d.text(identity.name), "Identity object");
    assert_eq!(d.entry(0x1018, 0).unwrap().default, Literal::Unsigned(3));
    let cob = d.entry(0x1014, 0).unwrap();
    assert_eq!(cob.default, Literal::NodeId(0x80));
    assert_eq!(cob.group, Group::Communication);
    let khz = d.entry(0x2100, 1).unwrap();
    assert_eq!(khz.data_type, DataType::Integer8);
    assert_eq!(khz.access, Access::Rw);
    assert_eq!(khz.group, Group::None);
    assert_eq!(
        (khz.default, khz.low, khz.high),
        (Literal::Signed(-3), Literal::Signed(-5), Literal::Signed(5))
    );
    let gain = d.entry(0x2101, 0).unwrap();
    assert_eq!(
        (gain.default, gain.low),
        (Literal::Real(1.5), Literal::Real(-2.0))
    );
    assert_eq!(
        d.literal_bytes(d.entry(0x2102, 0).unwrap().default),
        b"\x00\xFF\""
    );
    assert_eq!(
        d.literal_bytes(d.entry(0x1008, 0).unwrap().default),
        "GX µ \"1\"".as_bytes()
    );
    assert_eq!(d.entry(0x2103, 0).unwrap().default, Literal::Unsigned(1));
}

#[test]
fn a_handle_points_to_the_slot_of_its_entry() {
    let d = bench::DICTIONARY;
    assert_eq!(
        d.find(bench::POSITION.address()).unwrap().slot,
        bench::POSITION.slot()
    );
    assert_eq!(
        d.find(bench::KEY.address()).unwrap().slot,
        bench::KEY.slot()
    );
    assert_eq!(bench::DEVICE_TYPE.slot().len, 0, "const is not stored");
    assert_eq!(bench::STORE_LEN, d.store_len());
}

object_dictionary! {
    /// A device whose application streams a value.
    pub mod logger {
        warnings = off;
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8; default = 0 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x2000 { name = "Log"; type = DOMAIN; access = rw; capacity = 0 }
        add 0x2001 { name = "Note"; type = str; access = rw; default = "empty"; capacity = 300 }
    }
}

#[test]
fn a_capacity_is_room_in_the_store_and_0_is_a_stream() {
    // 1001h, 1018h, and the note with its length.
    assert_eq!(logger::STORE_LEN, 1 + 4 + 302);
    let log = logger::DICTIONARY.find(logger::LOG.address()).unwrap();
    assert!(log.is_streamed() && logger::DICTIONARY.has_streams());
    assert!(
        !bench::DICTIONARY.has_streams(),
        "a `const` text is not a stream"
    );
    // A block of 127 segments, where the longest value of the store has 300 bytes.
    let sizes = od_runtime::rooms::Sizes::of::<logger::Device>(&logger::DICTIONARY);
    assert_eq!(sizes.buffers, 889);
    const { assert!(<logger::Device as odkit::Services>::STREAMS) }
    const { assert!(!<bench::Device as odkit::Services>::STREAMS) }
}
