//! A member whose object has no section.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../../crates/od-eds/cases/E0208/bad.eds";
    }
}

fn main() {}
