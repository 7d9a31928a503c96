//! A mapping of an object that cannot be mapped.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/map_unmappable.eds";
    }
}

fn main() {}
