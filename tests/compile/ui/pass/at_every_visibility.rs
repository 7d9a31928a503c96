//! Modules in modules and in functions.

mod inner {
    odkit::object_dictionary! {
        pub(super) mod device {
            eds = "../eds/sound.eds";
            warnings = off;
            variant same {}
        }
    }
}

#[test]
fn compiles() {
    odkit::object_dictionary! {
        mod local {
            eds = "../eds/sound.eds";
            warnings = off;
        }
    }
    assert_eq!(local::DICTIONARY, inner::device::same::DICTIONARY);
}
