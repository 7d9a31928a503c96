//! An ObjectType that is not an object code.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0301/bad.eds";
    }
}

fn main() {}
