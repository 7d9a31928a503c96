//! A configured value that is not valid for its type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0413/bad.eds";
    }
}

fn main() {}
