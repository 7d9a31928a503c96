//! A mapped sub-index that does not exist.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0512/bad.eds";
    }
}

fn main() {}
