//! Names that are not valid in Rust.

use odkit::object_dictionary;

object_dictionary! {
    pub mod device {
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1018 { code = record; name = "Self" }
        add 0x1018sub1 { name = "type"; type = u32; default = 0x5F }
        add 0x2000 { name = "Dictionary"; type = u8 }
        add 0x2001 { name = "3 Größen (°C)"; type = u8 }
        add 0x2002 { name = "Var"; type = u8 }
        add 0x2003 { name = "Reserved"; type = u8 }
        add 0x2004 { name = "Reserved"; type = u8 }
        add 0x2005 { code = record; name = "Table" }
        add 0x2005sub1 { name = "Text"; type = str }
        add 0x2006 { name = "\"quoted\" \\ {} */ \n"; type = u8 }
        add 0x2007 { name = "7"; type = u8 }
        add 0x2008 { code = record; name = "7" }
        add 0x2008sub1 { name = "Basic"; type = u8 }
        add 0x2009 { name = "Basic"; type = u8 }
        variant table {}
        variant BASIC { remove 0x2000; }
    }
}

#[test]
fn compiles() {
    let _ = (device::self_::TYPE, device::DICTIONARY_2000);
    let _ = (device::_3_GROESSEN_DEG_C, device::VAR);
    let _ = (device::RESERVED_2003, device::RESERVED_2004);
    let _ = (device::table_2005::TEXT, device::table::DICTIONARY);
    let _ = device::QUOTED;
    let _ = (device::_7, device::_7_2008::BASIC, device::BASIC_2009);
    // A variant has the patterns of the handles that it keeps.
    let address = device::BASIC::_3_GROESSEN_DEG_C.address();
    assert!(matches!(address, device::BASIC::_3_GROESSEN_DEG_C::ADDRESS));
    assert!(!matches!(address, device::self_::TYPE::ADDRESS));
}
