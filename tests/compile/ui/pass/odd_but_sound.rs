//! Warnings do not stop a build, and neither does an error that the file allows.

use odkit::object_dictionary;

object_dictionary! {
    mod warned {
        eds = "../eds/odd_but_sound.eds";
        warnings = off;
    }
}

object_dictionary! {
    mod allowed {
        eds = "../eds/allowed.eds";
        warnings = off;
    }
}

#[test]
fn compiles() {
    assert_eq!(warned::DICTIONARY.objects().len(), 4);
    assert_eq!(allowed::DICTIONARY.objects().len(), 4);
}
