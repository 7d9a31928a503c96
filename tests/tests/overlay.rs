//! A device made by the macro from an EDS and an overlay equals the one made at run time.

use od_eds::Tables;
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../eds/small.eds" + "../eds/small.overlay";
        warnings = off;
    }
}

#[test]
fn compiled_and_loaded_are_the_same() {
    let [base, over] = [
        &include_bytes!("../eds/small.eds")[..],
        include_bytes!("../eds/small.overlay"),
    ]
    .map(|bytes| od_eds::decode(bytes).into_owned());
    let made = od_eds::overlay(&base, &over).expect("what it removes is there");
    let tables = Tables::new(&od_eds::parse(&made.text).description);
    assert!(tables.dictionary() == device::DICTIONARY);
    assert_eq!(device::LAMP.address().index, 0x5000);
    let kind = device::DICTIONARY.entry(0x1000, 0).expect("it is there");
    assert_eq!(kind.default.integer(1), Some(0x20196));
}
