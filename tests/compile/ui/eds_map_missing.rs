//! A mapping of an object that does not exist.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/map_missing.eds";
    }
}

fn main() {}
