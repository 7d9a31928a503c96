//! A formula that is too large for some node IDs.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0418/bad.eds";
    }
}

fn main() {}
