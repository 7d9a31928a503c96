//! A transmission type of another data type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0509/bad.eds";
    }
}

fn main() {}
