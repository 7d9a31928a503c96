//! No 1000h.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0601/bad.eds";
    }
}

fn main() {}
