//! A value with the type of a RECORD.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0403/bad.eds";
    }
}

fn main() {}
