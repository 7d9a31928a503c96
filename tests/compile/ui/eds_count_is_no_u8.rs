//! A sub-index 0 of another data type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0309/bad.eds";
    }
}

fn main() {}
