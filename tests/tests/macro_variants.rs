//! A family: the objects of its variants, and the handles that they share.

use od_model::Literal;
use od_model::typed::{Ro, Rw, Var};
use odkit::object_dictionary;

object_dictionary! {
    pub mod family {
        add 0x1000 { name = "Device type"; type = u32; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1008 { name = "Device name"; type = str; default = "short" }
        add 0x1018 { code = record; name = "Identity" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1018sub2 { name = "Product code"; type = u32; default = 10 }
        add 0x2000 { name = "Speed"; type = u16; access = rw; default = 3 }
        add 0x2001 { name = "Torque"; type = u16; access = rw; default = 4 }

        /// One turn only.
        variant single {
            modify 0x1018sub2 { default = 0x0B }
            modify 0x1008 { default = "a longer name" }
            remove 0x2000;
            rename 0x2001 = MOMENT;
            add 0x2110 { name = "Gear"; type = u16; access = rw; default = 7 }
        }
        variant wide {
            modify 0x2001 { type = u32 }
            rename 0x1018sub1 = VENDOR;
        }
        variant plain {}
    }
}

fn number(d: od_model::Dictionary<'_>, index: u16, sub: u8) -> Option<Literal> {
    d.entry(index, sub).map(|entry| entry.default)
}

#[test]
fn a_variant_is_its_base_with_the_edits() {
    let (base, single) = (family::DICTIONARY, family::single::DICTIONARY);
    assert_eq!(number(single, 0x1018, 2), Some(Literal::Unsigned(11)));
    assert_eq!(number(base, 0x1018, 2), Some(Literal::Unsigned(10)));
    assert_eq!(number(single, 0x2000, 0), None);
    assert_eq!(number(single, 0x2110, 0), Some(Literal::Unsigned(7)));
    assert_eq!(number(base, 0x2110, 0), None);
    assert_eq!(family::plain::DICTIONARY, base);
}

#[test]
fn a_handle_of_the_family_works_for_every_variant() {
    for d in [
        family::DICTIONARY,
        family::single::DICTIONARY,
        family::plain::DICTIONARY,
    ] {
        let slot = |index, sub| d.entry(index, sub).map(|e| e.slot);
        assert_eq!(slot(0x2001, 0), Some(family::TORQUE.slot()));
        assert_eq!(slot(0x1008, 0), Some(family::DEVICE_NAME.slot()));
        assert_eq!(slot(0x1018, 1), Some(family::identity::VENDOR_ID.slot()));
    }
    assert_eq!(family::single::MOMENT.slot(), family::TORQUE.slot());
}

#[test]
fn a_handle_of_another_type_belongs_to_the_variant() {
    let _: Var<u16, Rw> = family::TORQUE;
    let _: Var<u32, Rw> = family::wide::TORQUE;
    let _: Var<u32, Ro> = family::wide::identity::VENDOR;
    let wide = family::wide::DICTIONARY.entry(0x2001, 0).unwrap();
    assert_eq!(wide.slot, family::wide::TORQUE.slot());
    assert_ne!(wide.slot, family::TORQUE.slot());
}

#[test]
fn slots_do_not_overlap() {
    for d in [
        family::DICTIONARY,
        family::single::DICTIONARY,
        family::wide::DICTIONARY,
    ] {
        let mut end = 0;
        for slot in d.entries().iter().map(|e| e.slot).filter(|s| s.len > 0) {
            assert!(slot.offset >= end);
            end = slot.offset + u32::from(slot.len);
        }
        assert!(end as usize <= d.store_len());
    }
}
