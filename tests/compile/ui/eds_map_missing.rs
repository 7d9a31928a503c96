//! A mapping of an object that is not there.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/map_missing.eds";
    }
}

fn main() {}
