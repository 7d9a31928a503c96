//! A mapping entry of another data type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0510/bad.eds";
    }
}

fn main() {}
