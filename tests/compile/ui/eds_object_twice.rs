//! An object described twice.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/object_twice.eds";
    }
}

fn main() {}
