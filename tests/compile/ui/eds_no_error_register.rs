//! No 1001h.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0602/bad.eds";
    }
}

fn main() {}
