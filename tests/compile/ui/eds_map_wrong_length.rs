//! An object that is mapped with another length.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0504/bad.eds";
    }
}

fn main() {}
