//! More errors than are shown.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/many.eds";
    }
}

fn main() {}
