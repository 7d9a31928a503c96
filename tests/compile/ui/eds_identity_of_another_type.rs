//! A member of 1018h of another data type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0606/bad.eds";
    }
}

fn main() {}
