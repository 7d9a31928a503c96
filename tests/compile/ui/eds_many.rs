//! More errors than are shown.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/many.eds";
    }
}

fn main() {}
