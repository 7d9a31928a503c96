//! A dummy entry in a TPDO.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0507/bad.eds";
    }
}

fn main() {}
